// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/replay_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "reconstruct/metrics/flock_statistics.h"
#include "simulate/camera/camera_io.h"
#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "simulate/core/parameters.h"
#include "simulate/core/rng.h"
#include "simulate/core/scene_io.h"
#include "simulate/flock/load_scene.h"
#include "simulate/render/film.h"
#include "tools/replay_table.h"
#include "tools/scene_input.h"
#include "tools/scene_scenery.h"
#include "tools/stage.h"
#include "tools/walls.h"

namespace flocklift {
namespace {

// The film starts with the replay's first frame.
Trajectories FromFrameOne(Trajectories flock, int start_frame) {
  for (Trajectory& trajectory : flock.trajectories) {
    for (TrajectoryPoint& point : trajectory.points) point.frame -= start_frame - 1;
  }
  return flock;
}

constexpr double kFirstTimes[] = {0.1, 0.2, 0.5};  // [s]

// 0.1, 0.2, 0.5, 1, 2, 3 .. 10, 20, 30 .. 100, ... s, as far as the replay goes, and its end.
bool IsReported(double time, double frame_time, bool last) {
  const auto near = [&](double wanted) { return std::abs(time - wanted) < 0.5 * frame_time; };
  if (last) return true;
  if (time < 1 - 0.5 * frame_time)
    return std::any_of(std::begin(kFirstTimes), std::end(kFirstTimes), near);
  const double unit = std::pow(10, std::floor(std::log10(time + 0.5 * frame_time)));
  return near(unit * std::round(time / unit));
}

nlohmann::ordered_json DivergenceSeries(const std::vector<Divergence>& divergence, double fps,
                                        bool guided) {
  nlohmann::ordered_json series = nlohmann::ordered_json::array();
  for (const Divergence& d : divergence) {
    if (!IsReported(d.time, 1 / fps, &d == &divergence.back())) continue;
    series.push_back({{"time", d.time},
                      {"animals", d.animals},
                      {"model_rms", d.model_rms},
                      {"noiseless_rms", d.noiseless_rms},
                      {"straight_on_rms", d.straight_on_rms}});
    if (!guided && d.perturbed_rms > 0) series.back()["perturbed_rms"] = d.perturbed_rms;
  }
  return series;
}

nlohmann::ordered_json OrNull(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

nlohmann::ordered_json StatisticsAsJson(const FlockStatistics& s) {
  return {{"animals", s.count},
          {"polarisation", OrNull(s.polarisation)},
          {"median_speed", s.speed_median},
          {"median_neighbour_distance", OrNull(s.neighbour_median)}};
}

// Reconstruction and replay side by side, at the frames in which both have animals.
nlohmann::ordered_json StatisticsSeries(const Trajectories& reconstruction,
                                        const ReplayResult& result, double fps) {
  std::map<int, FlockStatistics> before;
  for (const FlockStatistics& s : ComputeFlockStatistics(StatesByFrame(reconstruction))) {
    before[s.frame] = s;
  }
  const std::vector<FlockStatistics> after = ComputeFlockStatistics(StatesByFrame(result.replayed));
  nlohmann::ordered_json series = nlohmann::ordered_json::array();
  for (const FlockStatistics& s : after) {
    const double time = (s.frame - result.start_frame) / fps;
    const auto found = before.find(s.frame);
    if (found == before.end()) continue;
    if (time > 0 && !IsReported(time, 1 / fps, &s == &after.back())) continue;
    series.push_back({{"time", time},
                      {"reconstruction", StatisticsAsJson(found->second)},
                      {"replay", StatisticsAsJson(s)}});
  }
  return series;
}

}  // namespace

std::vector<Animal> BodiesOf(const Trajectories& flock, double wingspan, std::uint64_t seed) {
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

void RunReplay(const ReplayCommand& command, const CommonOptions& common) {
  Stage stage("replay", common);
  stage.options() = OptionsAsJson(command.replay);
  stage.options()["seed"] = common.seed;
  if (common.fps) stage.options()["fps"] = *common.fps;
  RequireFile(command.trajectories, "give the file that `flocklift reconstruct` wrote");
  RequireFile(command.parameters, "give the file that `flocklift fit` wrote");
  stage.AddInput(command.trajectories);
  stage.AddInput(command.parameters);
  const std::optional<Region> walls = ParseWalls(command.walls);
  if (walls) stage.options()["walls"] = command.walls;
  const std::vector<ObstacleSpec> obstacles = ParseObstacles(command.obstacles);
  if (!obstacles.empty()) stage.options()["obstacles"] = command.obstacles;
  for (const ObstacleSpec& obstacle : obstacles) {
    if (obstacle.mesh) stage.AddInput(*obstacle.mesh);
  }
  std::optional<Scene> scene;
  if (!command.scene.empty()) {
    scene = ReadSceneAsInput(command.scene, &stage);
  }
  std::optional<Camera> camera;
  if (!command.camera.empty()) {
    stage.AddInput(command.camera);
    stage.options()["wingspan"] = command.wingspan;
    stage.options()["no_video"] = command.no_video;
    camera = ReadCamera(command.camera);
    if (!command.no_video) stage.AddOutput("video.mp4");
  }
  stage.AddOutput("trajectories.csv");
  if (stage.IsUpToDate()) return;

  Trajectories reconstruction = ReadTrajectories(command.trajectories);
  Parameters parameters = ReadParameters(command.parameters);
  if (walls) parameters.walls = walls;
  std::optional<double> fps = common.fps ? common.fps : reconstruction.fps;
  if (!fps && camera) fps = camera->fps;
  if (!fps) {
    throw InputError(command.trajectories.string(), 0, "says no frames per second", "give --fps");
  }
  if (!reconstruction.has_velocity) ComputeVelocities(*fps, &reconstruction);

  const Progress progress = stage.BeginPhase("fly");
  const ReplayResult result = Replay(command.replay, parameters, reconstruction, *fps, common.seed,
                                     common.ThreadCount(), progress, obstacles, scene);
  if (camera && !command.no_video) {
    const Progress film = stage.BeginPhase("film");
    Scene surroundings;
    if (scene) surroundings.obstacles = scene->obstacles;
    surroundings.obstacles.insert(surroundings.obstacles.end(), obstacles.begin(), obstacles.end());
    const std::vector<Obstacle> solid = LoadObstacles(surroundings);
    const Scenery scenery = SceneObstacles(solid);
    FilmTrajectories(
        common.out / "video.mp4", FromFrameOne(result.replayed, result.start_frame),
        BodiesOf(result.replayed, command.wingspan, common.seed), *camera, {},
        {.fps = *fps, .seed = common.seed, .threads = common.ThreadCount(), .scenery = &scenery},
        film);
  }
  stage.BeginPhase("write", "files");
  WriteTrajectories(common.out / "trajectories.csv", result.replayed);
  stage.EndPhase();
  stage.figures() = {
      {"start_frame", result.start_frame},
      {"agents", result.replayed.trajectories.size()},
      {"guided", command.replay.alpha < 1},
      {"divergence", DivergenceSeries(result.divergence, *fps, command.replay.alpha < 1)},
      {"statistics", StatisticsSeries(reconstruction, result, *fps)}};
  stage.Finish();
  if (common.quiet || common.json) return;
  fmt::print(stderr, "{}",
             ReplayTable(stage.figures().at("divergence"), stage.figures().at("statistics")));
}

void AddReplayCommand(CLI::App& app) {
  std::shared_ptr<ReplayCommand> command;
  CLI::App* sub = AddSubcommand<ReplayCommand>(
      app, "replay", "Fly a reconstructed flock on by a fitted model",
      "Examples:\n"
      "  flocklift replay trajectories.csv --parameters parameters.toml --out replay\n"
      "  flocklift replay trajectories.csv --parameters parameters.toml --count 5000 \\\n"
      "      --camera camera.yaml --out replay\n"
      "  flocklift replay flies.csv --parameters parameters.toml --obstacle 0.1,0,1,0.05\n"
      "  flocklift replay flies.csv --parameters parameters.toml --scene moon.toml",
      {.fps = true, .seed = true}, &RunReplay, &command);
  sub->add_option("trajectories", command->trajectories, "trajectories (CSV, or HDF5)")->required();
  sub->add_option("--parameters", command->parameters, "parameters.toml of `flocklift fit`")
      ->required();
  sub->add_option("--scene", command->scene,
                  "scene file whose surroundings they fly in (shapes, paths, goals, obstacles, "
                  "wind, predators, events), by its steps; shape, morph and crowd need it, and "
                  "forces where they feel wind or predators. A morph's tetrahedra fly from the "
                  "scene's own start, each animal as the one that it was nearest to");
  sub->add_option("--camera", command->camera, "camera file; also film the replay");
  sub->add_flag("--no-video", command->no_video, "write no video");
  AddWallsFlag(*sub, &command->walls);
  AddObstacleFlag(*sub, &command->obstacles);
  sub->add_option("--wingspan", command->wingspan, "of the animals in the film [m]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  AddFlags(*sub, command->replay, "Replay");
}

}  // namespace flocklift
