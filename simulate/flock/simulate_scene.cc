// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/simulate_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <memory>
#include <optional>

#include "simulate/core/rigid3.h"
#include "simulate/flock/frame_record.h"
#include "simulate/flock/population.h"
#include "simulate/flock/scene_checkpoint.h"
#include "simulate/shapes/animated_mesh_writer.h"
#include "simulate/shapes/tetra_mesh.h"

namespace flocklift {
namespace {

constexpr double kGravity = 9.81;       // [m/s^2]
constexpr double kLeastLift = 1.0 / 3;  // of the weight: no bird flies upside down

// world_from_body of a bird that flies along v and turns with acceleration a.
Quaternion Bank(const Vec3d& v, const Vec3d& a) {
  const Vec3d forward = Normalized(v);
  const Vec3d felt{a.x, a.y, std::max(a.z + kGravity, kLeastLift * kGravity)};
  const Vec3d up = Normalized(felt - Dot(felt, forward) * forward);
  if (forward == Vec3d{} || up == Vec3d{}) {
    return QuaternionFromRotation(WorldFromLevelBody(v));
  }
  return QuaternionFromRotation(Rotation3d::FromRows(forward, Cross(up, forward), up).Inverse());
}

// Adds the time that `work` takes.
template <typename Work>
void Timed(double* wall_s, double* cpu_s, const Work& work) {
  const auto wall = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  work();
  *wall_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
  *cpu_s += static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
}

// As far as anything may ever get from where it was [m].
double ExtentOf(const World& world) {
  constexpr double kFar = World::kFar;
  Vec3d low{kFar, kFar, kFar}, high = -low;
  const auto take = [&](const Vec3d& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  };
  for (const ShapeInTime& shape : world.shapes) {
    for (const TriangleMesh& mesh : shape.meshes) {
      for (const Vec3d& p : mesh.vertices) take(p);
    }
  }
  for (const PathSpec& path : world.paths) {
    for (const Vec3d& p : path.points) take(p);
  }
  const Vec3d size = high - low;
  return 1.1 * std::max({size.x, size.y, size.z});
}

AnimatedMeshWriter OpenTetrahedra(const std::filesystem::path& path, const Scene& scene,
                                  const World& world, std::size_t corners) {
  std::vector<std::array<std::uint32_t, 3>> faces;
  for (std::uint32_t first = 0; first < corners; first += 4) {
    for (const auto& [a, b, c] : kTetraFaces) {
      faces.push_back({first + static_cast<std::uint32_t>(a), first + static_cast<std::uint32_t>(b),
                       first + static_cast<std::uint32_t>(c)});
    }
  }
  return AnimatedMeshWriter(path, faces, corners,
                            {.fps = scene.fps,
                             .most_frames = scene.FrameCount(),
                             .quantize = true,
                             .extent = ExtentOf(world)});
}

void AddOrientations(double fps, Trajectory* trajectory) {
  std::vector<TrajectoryPoint>& points = trajectory->points;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t before = k > 0 ? k - 1 : k;
    const std::size_t after = k + 1 < points.size() ? k + 1 : k;
    Vec3d a;
    if (after > before) {
      a = (fps / static_cast<double>(after - before)) *
          (points[after].velocity - points[before].velocity);
    }
    points[k].world_from_body = Bank(points[k].velocity, a);
  }
}

}  // namespace

SceneResult SimulateScene(const Scene& scene, const SimulateOptions& options,
                          const Progress& progress) {
  SceneResult result;
  Population population;
  std::optional<Engine> engine;
  Timed(&result.prepare_wall_s, &result.prepare_cpu_s, [&] {
    population = Populate(scene);
    engine.emplace(population.world, population.swarms,
                   EngineOptions{.threads = options.threads, .kernel = {}});
  });

  const auto warmup_frames = static_cast<std::int64_t>(std::llround(scene.warmup * scene.fps));
  const std::int64_t frames = scene.FrameCount();
  result.truth.fps = scene.fps;
  result.truth.has_velocity = result.truth.has_orientation = true;
  for (const Animal& animal : population.animals) {
    result.truth.trajectories.push_back({.id = animal.id, .points = {}});
    result.truth.trajectories.back().points.reserve(static_cast<std::size_t>(frames));
  }
  const std::size_t corners = engine->TetrahedraCorners().size();
  std::unique_ptr<AnimatedMeshWriter> tetrahedra;
  if (!options.tetrahedra.empty() && corners > 0 && frames > 0) {
    tetrahedra.reset(new AnimatedMeshWriter(
        OpenTetrahedra(options.tetrahedra, scene, population.world, corners)));
  }
  SceneCheckpoint checkpoint(options.checkpoint, options.checkpoint_every, scene);
  std::int64_t frame = 1 - warmup_frames;
  checkpoint.Resume(&*engine, &frame, &result.truth, tetrahedra.get(), corners);
  FrameRecord record(&result.truth);
  for (; frame <= frames; ++frame) {
    if (frame > 0) record.Add(static_cast<int>(frame), engine->State());
    if (frame > 0 && tetrahedra) {
      const std::vector<Vec3<float>> shape = engine->TetrahedraCorners();
      tetrahedra->AddFrame(shape);
      checkpoint.AddCorners(shape);
    }
    if (frame < frames) {
      Timed(&result.step_wall_s, &result.step_cpu_s, [&] {
        for (int k = 0; k < scene.substeps; ++k) engine->Step();
      });
    }
    if (checkpoint.Due()) {
      record.Flush();
      checkpoint.Keep(*engine, frame, result.truth);
    }
    Report(progress, frame + warmup_frames, frames + warmup_frames);
  }
  record.Flush();
  checkpoint.Remove();
  if (tetrahedra) tetrahedra->Finish();
  for (Trajectory& trajectory : result.truth.trajectories) AddOrientations(scene.fps, &trajectory);

  result.agents = static_cast<std::int64_t>(population.animals.size());
  for (const PredatorSpec& predators : scene.predators) result.agents -= predators.count;
  result.animals = std::move(population.animals);
  result.obstacles = std::move(population.world.obstacles);
  result.steps = engine->steps();
  result.mean_neighbours = engine->MeanNeighbours();
  result.mde_share = engine->MdeShare();
  return result;
}

}  // namespace flocklift
