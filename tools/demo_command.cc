// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/demo_command.h"

#include <fmt/format.h>

#include <memory>

#include "simulate/core/atomic_file.h"
#include "simulate/core/scene_io.h"
#include "tools/demo_scene.h"
#include "tools/evaluate_command.h"
#include "tools/report_command.h"
#include "tools/run_command.h"
#include "tools/simulate_command.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

// What a user would know of the birds: the species' mean wingspan within 5 % and speed within 10 %.
constexpr double kWingspanSd = 0.05, kSpeedSd = 0.1;

// The out folder of one part; what it made before and would make again is kept.
CommonOptions Inside(const CommonOptions& common, const char* folder) {
  CommonOptions inside = common;
  inside.out = common.out / folder;
  inside.reuse = true;
  inside.json = false;
  return inside;
}

}  // namespace

void RunDemo(const DemoCommand& command, const CommonOptions& common) {
  const CommonOptions truth = Inside(common, "truth");
  const CommonOptions result = Inside(common, "result");
  fs::path scene_path = command.scene;
  if (scene_path.empty()) {
    scene_path = truth.out / "scene.toml";
    WriteTextFile(scene_path, kDemoScene);
  }
  const SpeciesSpec species = ReadScene(scene_path).species.at(0);

  SimulateCommand simulate;
  simulate.scene = scene_path;
  RunSimulate(simulate, truth);

  RunCommand run;
  run.track.video = truth.out / "video.mp4";
  run.reconstruct.camera = truth.out / "camera.yaml";
  run.reconstruct.wingspan =
      fmt::format("{},{:.6g}", species.wingspan, kWingspanSd * species.wingspan);
  run.reconstruct.speed = fmt::format("{},{}", species.speed, kSpeedSd * species.speed);
  RunRun(run, result);

  // The same tracks and knowledge by the published baseline, to compare with.
  CommonOptions baseline = Inside(result, "cobyla");
  ReconstructCommand cobyla = run.reconstruct;
  cobyla.tracks = result.out / "tracks.csv";
  cobyla.method = "cobyla";
  RunReconstruct(cobyla, baseline);

  RunEvaluate({.round_trip = common.out, .shares = false}, common);
  // Once more, now that the scores are there to be shown.
  RunReport({.folder = result.out, .truth = truth.out}, result);
}

void AddDemoCommand(CLI::App& app) {
  std::shared_ptr<DemoCommand> command;
  CLI::App* sub = AddSubcommand<DemoCommand>(
      app, "demo", "Simulate, film, track, reconstruct, fit, replay, and score against the truth",
      "Examples:\n"
      "  flocklift demo --out demo     then open demo/result/report.html",
      {}, &RunDemo, &command);
  sub->add_option("--scene", command->scene, "another scene than the built-in one");
}

}  // namespace flocklift
