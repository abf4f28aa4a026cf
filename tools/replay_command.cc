// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/replay_command.h"

#include <algorithm>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "simulate/camera/camera_io.h"
#include "simulate/core/animal.h"
#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "simulate/core/parameters.h"
#include "simulate/core/rng.h"
#include "simulate/render/film.h"
#include "tools/stage.h"

namespace flocklift {
namespace {

// Bodies to film: alike but for the phase of their wingbeats.
std::vector<Animal> AnimalsOf(const Trajectories& flock, double wingspan, std::uint64_t seed) {
  std::vector<Animal> animals;
  for (const Trajectory& trajectory : flock.trajectories) {
    Rng rng(seed, static_cast<std::uint64_t>(trajectory.id));
    animals.push_back({.id = trajectory.id,
                       .wingspan = wingspan,
                       .body_length = 0.5 * wingspan,
                       .wingbeat_phase = rng.Uniform(0, 2 * std::numbers::pi)});
  }
  return animals;
}

// The film starts with the replay's first frame.
Trajectories FromFrameOne(Trajectories flock, int start_frame) {
  for (Trajectory& trajectory : flock.trajectories) {
    for (TrajectoryPoint& point : trajectory.points) point.frame -= start_frame - 1;
  }
  return flock;
}

// Divergence at round times, at most ten a decade, for the summary.
nlohmann::ordered_json DivergenceSeries(const std::vector<Divergence>& divergence) {
  nlohmann::ordered_json series = nlohmann::ordered_json::array();
  double next = 0;
  for (const Divergence& d : divergence) {
    if (d.time + 1e-9 < next && &d != &divergence.back()) continue;
    series.push_back({{"time", d.time},
                      {"animals", d.animals},
                      {"model_rms", d.model_rms},
                      {"straight_on_rms", d.straight_on_rms}});
    next = std::max(d.time + 0.1, 1.1 * d.time);
  }
  return series;
}

}  // namespace

void RunReplay(const ReplayCommand& command, const CommonOptions& common) {
  Stage stage("replay", common);
  stage.options() = OptionsAsJson(command.replay);
  stage.options()["seed"] = common.seed;
  if (common.fps) stage.options()["fps"] = *common.fps;
  RequireFile(command.trajectories, "give the file that `flocklift reconstruct` wrote");
  RequireFile(command.parameters, "give the file that `flocklift fit` wrote");
  stage.AddInput(command.trajectories);
  stage.AddInput(command.parameters);
  std::optional<Camera> camera;
  if (!command.camera.empty()) {
    stage.AddInput(command.camera);
    stage.options()["wingspan"] = command.wingspan;
    camera = ReadCamera(command.camera);
    stage.AddOutput("video.mp4");
  }
  stage.AddOutput("trajectories.csv");
  if (stage.IsUpToDate()) return;

  Trajectories reconstruction = ReadTrajectories(command.trajectories);
  const Parameters parameters = ReadParameters(command.parameters);
  std::optional<double> fps = common.fps ? common.fps : reconstruction.fps;
  if (!fps && camera) fps = camera->fps;
  if (!fps) {
    throw InputError(command.trajectories.string(), 0, "says no frames per second", "give --fps");
  }
  if (!reconstruction.has_velocity) ComputeVelocities(*fps, &reconstruction);

  const Progress progress = stage.BeginPhase("fly");
  const ReplayResult result = Replay(command.replay, parameters.model, reconstruction, *fps,
                                     common.seed, common.ThreadCount(), progress);
  if (camera) {
    const Progress film = stage.BeginPhase("film");
    FilmTrajectories(common.out / "video.mp4", FromFrameOne(result.replayed, result.start_frame),
                     AnimalsOf(result.replayed, command.wingspan, common.seed), *camera, {},
                     {.fps = *fps, .seed = common.seed, .threads = common.ThreadCount()}, film);
  }
  stage.BeginPhase("write", "files");
  WriteTrajectories(common.out / "trajectories.csv", result.replayed);
  stage.EndPhase();
  stage.figures() = {{"start_frame", result.start_frame},
                     {"agents", result.replayed.trajectories.size()},
                     {"divergence", DivergenceSeries(result.divergence)}};
  stage.Finish();
}

void AddReplayCommand(CLI::App& app) {
  std::shared_ptr<ReplayCommand> command;
  CLI::App* sub = AddSubcommand<ReplayCommand>(
      app, "replay", "Fly a reconstructed flock on by a fitted model",
      "Examples:\n"
      "  flocklift replay trajectories.csv --parameters parameters.toml --out replay\n"
      "  flocklift replay trajectories.csv --parameters parameters.toml --count 5000 \\\n"
      "      --camera camera.yaml --out replay",
      {.fps = true, .seed = true}, &RunReplay, &command);
  sub->add_option("trajectories", command->trajectories, "trajectories (CSV, or HDF5)")->required();
  sub->add_option("--parameters", command->parameters, "parameters.toml of `flocklift fit`")
      ->required();
  sub->add_option("--camera", command->camera, "camera file; also film the replay");
  sub->add_option("--wingspan", command->wingspan, "of the animals in the film [m]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  AddFlags(*sub, command->replay, "Replay");
}

}  // namespace flocklift
