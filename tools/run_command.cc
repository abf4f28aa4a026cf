// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/run_command.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "simulate/camera/camera_io.h"
#include "simulate/core/check.h"
#include "tools/report_command.h"
#include "tools/stage.h"

namespace flocklift {
namespace {

void RunReplayOf(const RunCommand& command, const FitCommand& fit, CommonOptions common) {
  ReplayCommand replay = command.replay;
  replay.trajectories = fit.trajectories;
  replay.parameters = common.out / "parameters.toml";
  replay.camera = fit.camera;
  common.out /= "replay";
  RunReplay(replay, common);
}

}  // namespace

void RunRun(const RunCommand& command, const CommonOptions& common) {
  CommonOptions stage = common;  // each stage keeps what it made before and would make again
  stage.reuse = true;
  stage.json = false;
  RequireFile(command.reconstruct.camera,
              "make one with `flocklift camera` or `flocklift calibrate`");

  Check(command.fit.model != kKernelsModel,
        "--model kernels leaves nothing to replay: give a model to `run`, then `flocklift fit "
        "trajectories.csv --model kernels` on what it wrote");
  ReadCamera(command.reconstruct.camera);  // what would fail after the tracking fails before it
  KnowledgeOf(command.reconstruct);

  RunTrack(command.track, stage);

  ReconstructCommand reconstruct = command.reconstruct;
  reconstruct.tracks = common.out / "tracks.csv";
  reconstruct.shapes = common.out / "shapes.csv";
  RunReconstruct(reconstruct, stage);

  FitCommand fit = command.fit;
  fit.trajectories = common.out / "trajectories.csv";
  fit.camera = reconstruct.camera;
  try {
    RunFit(fit, stage);
    RunReplayOf(command, fit, stage);
  } catch (const CannotFit& reason) {
    // Not of this film, then; what an earlier one left must not pass for its own.
    std::filesystem::remove(common.out / "parameters.toml");
    std::filesystem::remove(common.out / "summary.fit.json");
    std::filesystem::remove_all(common.out / "replay");
    if (!common.quiet) fmt::print(stderr, "flocklift run: warning: no fit: {}\n", reason.what());
  }

  RunReport({.folder = common.out}, stage);
}

void AddRunCommand(CLI::App& app) {
  std::shared_ptr<RunCommand> command;
  CLI::App* sub = AddSubcommand<RunCommand>(
      app, "run", "All of track, reconstruct, fit, replay and report; only what changed",
      "Examples:\n"
      "  flocklift camera --fov 50 --size 1280x720 --out run\n"
      "  flocklift run birds.mp4 --camera run/camera.yaml --wingspan 1.7,0.15 --out run",
      {.fps = true, .seed = true}, &RunRun, &command);
  sub->add_option("video", command->track.video,
                  "a video file, an image-sequence pattern or a folder of images")
      ->required();
  sub->add_option("--camera", command->reconstruct.camera, "camera file")->required();
  sub->add_option("--corrections", command->track.corrections, "a person's edits of the tracks");
  sub->add_flag("--overlay", command->track.overlay, "also write overlay.mp4");
  sub->add_option("--method", command->reconstruct.method,
                  "auto, batch, dynamics or cobyla, as of reconstruct")
      ->check(CLI::IsMember({"auto", "batch", "dynamics", "cobyla"}))
      ->capture_default_str();
  sub->add_option("--model", command->fit.model, "the model to fit")->capture_default_str();
  AddKnowledgeFlags(*sub, &command->reconstruct);
  AddFlags(*sub, command->track.tracker, "Tracker");
  AddFlags(*sub, command->reconstruct.batch, "Method batch");
}

}  // namespace flocklift
