// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/depth_case.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "simulate/camera/camera_io.h"
#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "simulate/core/scene_io.h"
#include "simulate/flock/simulate_scene.h"
#include "tools/scene_camera.h"

namespace flocklift {
namespace {

constexpr double kSpeedSd = 0.1, kWingspanSd = 0.05;  // relative

void ShareBirds(int birds, Scene* scene) {
  int all = 0;
  for (const SpeciesSpec& species : scene->species) all += species.count;
  int before = 0, given = 0;
  for (SpeciesSpec& species : scene->species) {
    before += species.count;
    const int up_to = birds * before / all;
    species.count = up_to - given;
    given = up_to;
    Check(species.count > 0, "too few birds for the species of the scene");
  }
}

// Only the rows that the tracks have too.
Trajectories InTracks(const Trajectories& truth, const Tracks& tracks) {
  std::map<Id, std::set<int>> frames;
  for (const Tracklet& tracklet : tracks.tracklets) {
    for (const Detection& seen : tracklet.detections) frames[tracklet.id].insert(seen.frame);
  }
  Trajectories kept = truth;
  for (Trajectory& path : kept.trajectories) {
    const std::set<int>& there = frames[path.id];
    std::erase_if(path.points, [&](const TrajectoryPoint& p) { return !there.contains(p.frame); });
  }
  std::erase_if(kept.trajectories, [](const Trajectory& path) { return path.points.empty(); });
  return kept;
}

double MeanSpeed(const Trajectories& truth) {
  double sum = 0, rows = 0;
  for (const Trajectory& path : truth.trajectories) {
    for (const TrajectoryPoint& point : path.points) {
      sum += Norm(point.velocity);
      ++rows;
    }
  }
  Check(rows > 0, "nothing of the scene is in view");
  return sum / rows;
}

}  // namespace

const std::vector<DepthCase>& DepthCases() {
  static const std::vector<DepthCase> cases = {
      {.scene = "circling"},
      {.scene = "hard_edges"},
      {.scene = "transit"},
      {.scene = "crossing", .faults = {.gaps = 5, .gap_length = 8, .switches = 2}},
      {.scene = "off_prior",
       .faults = {.size_drift_sd = 0.1, .size_drift_time = 2},
       .told_speed = 1 / 1.15}};
  return cases;
}

DepthTwin MakeDepthTwin(const DepthCase& depth_case, const std::filesystem::path& scene_folder,
                        int birds, std::uint64_t seed, int threads) {
  Scene scene = ReadScene(scene_folder / ("depth_" + depth_case.scene + ".toml"));
  ShareBirds(birds, &scene);
  constexpr std::uint64_t kApart = 1000;  // seeds of one scene from the next scene's
  scene.seed = kApart * scene.seed + seed;
  DepthTwin twin;
  twin.fps = scene.fps;
  twin.camera = SceneCamera(scene);
  const SceneResult result = SimulateScene(scene, {.threads = threads}, {});
  const Tracks seen =
      SynthesizeTracks(result.truth, result.animals, twin.camera, scene.fps, threads);
  const Tracks noisy = SynthesizeFaults(depth_case.faults, scene.seed, scene.fps,
                                        SynthesizeNoise(depth_case.noise, scene.seed, seen));
  const auto switches = SynthesizeSwitches(depth_case.faults, scene.seed, seen);
  twin.tracks = WithSwitches(switches, noisy);
  twin.truth = InTracks(WithSwitches(switches, result.truth), twin.tracks);
  twin.camera.intrinsics.fx *= depth_case.told_focal;
  twin.camera.intrinsics.fy *= depth_case.told_focal;
  double wingspan = 0;
  for (const Animal& animal : result.animals) wingspan += animal.wingspan;
  wingspan /= static_cast<double>(result.animals.size());
  const double speed = depth_case.told_speed * MeanSpeed(twin.truth);
  twin.knowledge.speed = Uncertain{speed, kSpeedSd * speed};
  twin.knowledge.wingspan = Uncertain{wingspan, kWingspanSd * wingspan};
  return twin;
}

void WriteDepthTwin(const std::filesystem::path& folder, const DepthTwin& twin) {
  std::filesystem::create_directories(folder);
  WriteTrajectories(folder / "truth.csv", twin.truth);
  WriteTracks(folder / "tracks.csv", twin.tracks);
  WriteShapes(folder / "shapes.csv", twin.tracks);
  WriteCamera(folder / "camera.yaml", twin.camera);
}

}  // namespace flocklift
