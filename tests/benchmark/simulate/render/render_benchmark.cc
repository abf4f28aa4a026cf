// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Frames per second of a 1080p film of a flock with clouds, noise, blur and haze: drawing alone,
// and drawing with encoding on all cores. The argument is the number of birds.

#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/media/yuv420.h"
#include "simulate/render/film.h"
#include "simulate/render/flight.h"
#include "simulate/render/renderer.h"
#include "simulate/render/surface.h"

namespace flocklift {
namespace {

constexpr double kFps = 30;
constexpr int kFrames = 120;

Camera GroundCamera() {
  Camera camera = PinholeCamera(50, 1920, 1080);
  camera.cam_from_world = LookAt({0, -45, 1.7}, {0, 0, 12});
  return camera;
}

// Birds on circles at 10 m/s, 30 to 75 m away.
struct Flock {
  Trajectories trajectories;
  std::vector<Animal> animals;

  explicit Flock(int birds) {
    for (Id id = 1; id <= birds; ++id) {
      Rng rng(5, static_cast<std::uint64_t>(id));
      const Vec3d center{rng.Uniform(-8, 8), rng.Uniform(-5, 15), rng.Uniform(6, 18)};
      const double radius = rng.Uniform(8, 16), phase = rng.Uniform(0, 6.28);
      Trajectory& bird = trajectories.trajectories.emplace_back();
      bird.id = id;
      for (int frame = 1; frame <= kFrames; ++frame) {
        const double angle = phase + 10 / radius * (frame - 1) / kFps;
        bird.points.push_back(
            {.frame = frame,
             .position = center + radius * Vec3d{std::cos(angle), std::sin(angle), 0},
             .velocity = {},
             .world_from_body = {}});
      }
      animals.push_back({.id = id,
                         .wingspan = 0.7 * std::exp(0.05 * rng.Normal()),
                         .wingbeat_hz = 5 + 0.5 * rng.Normal(),
                         .wingbeat_phase = rng.Uniform(0, 6.28)});
    }
  }
};

// One thread.
void DrawFrame(benchmark::State& state) {
  const Flock flock(static_cast<int>(state.range(0)));
  const Camera camera = GroundCamera();
  const Flight flight(flock.trajectories, flock.animals, camera, kFps);
  const FlockRenderer renderer(camera, {}, kFps, 1);
  int frame = 0;
  for (auto _ : state) {
    frame = frame % kFrames + 1;
    benchmark::DoNotOptimize(renderer.Render(frame, flight.TimeOf(frame), flight.At(frame)));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(DrawFrame)->Arg(0)->Arg(30)->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);

// All of a film, encoded: items are frames.
void FilmFlock(benchmark::State& state) {
  const Flock flock(static_cast<int>(state.range(0)));
  const auto path = std::filesystem::temp_directory_path() / "flocklift_render_benchmark.mp4";
  for (auto _ : state) {
    FilmTrajectories(path, flock.trajectories, flock.animals, GroundCamera(), {}, {.fps = kFps});
  }
  state.SetItemsProcessed(state.iterations() * kFrames);
  state.counters["MB_per_s_of_film"] =
      static_cast<double>(std::filesystem::file_size(path)) / 1e6 / (kFrames / kFps);
  std::filesystem::remove(path);
}
BENCHMARK(FilmFlock)
    ->Arg(30)
    ->Arg(100)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

// 1280 x 720, one thread, drawing alone. Insects in a cloud 20 m away, below a pixel each, moving
// 3 px while the shutter is open. The argument is their number.
void DrawSwarm(benchmark::State& state) {
  Camera camera = PinholeCamera(50, 1280, 720);
  camera.cam_from_world = LookAt({0, -20, 1.7}, {0, 0, 5});
  std::vector<FlyingAnimal> swarm;
  for (Id id = 1; id <= state.range(0); ++id) {
    Rng rng(6, static_cast<std::uint64_t>(id));
    FlyingAnimal& insect = swarm.emplace_back();
    insect.animal = {.id = id,
                     .wingspan = 0.012 * std::exp(0.05 * rng.Normal()),
                     .body_length = 0.006,
                     .wingbeat_hz = 25,
                     .wingbeat_phase = rng.Uniform(0, 6.28)};
    insect.position = {4 * rng.Normal(), 4 * rng.Normal(), 5 + 2 * rng.Normal()};
    insect.velocity = {4 * rng.Normal(), 4 * rng.Normal(), rng.Normal()};
    insect.world_from_body = WorldFromLevelBody(insect.velocity);
  }
  const FlockRenderer renderer(camera, {}, kFps, 1);
  int frame = 0;
  for (auto _ : state) {
    ++frame;
    benchmark::DoNotOptimize(renderer.Render(frame, frame / kFps, swarm));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(DrawSwarm)->Arg(0)->Arg(10'000)->Arg(256'000)->Unit(benchmark::kMillisecond);

// The same picture with tetrahedra of about 10 cm instead, in motion or at rest.
void DrawTetrahedra(benchmark::State& state) {
  Camera camera = PinholeCamera(50, 1280, 720);
  camera.cam_from_world = LookAt({0, -20, 1.7}, {0, 0, 5});
  const auto count = static_cast<std::size_t>(state.range(0));
  std::vector<Vec3d> vertices, velocities;
  for (std::size_t k = 0; k < count; ++k) {
    Rng rng(7, k);
    const Vec3d middle{3 * rng.Normal(), 3 * rng.Normal(), 5 + 2 * rng.Normal()};
    const Vec3d velocity{4 * rng.Normal(), 4 * rng.Normal(), rng.Normal()};
    for (int corner = 0; corner < 4; ++corner) {
      vertices.push_back(middle + 0.08 * Vec3d{rng.Normal(), rng.Normal(), rng.Normal()});
      velocities.push_back(velocity);
    }
    Vec3d* const corner = vertices.data() + 4 * k;
    const Vec3d up = Cross(corner[1] - corner[0], corner[2] - corner[0]);
    if (Dot(up, corner[3] - corner[0]) < 0) std::swap(corner[2], corner[3]);
  }
  const auto faces = TetrahedraFaces(count);
  const std::vector<Color> tones{{90, 140, 200}};
  Surface surface{
      .vertices = vertices, .triangles = faces, .tones = tones, .normals = {}, .velocities = {}};
  surface.is_closed = true;
  if (state.range(1) != 0) surface.velocities = velocities;
  const FlockRenderer renderer(camera, {}, kFps, 1);
  int frame = 0;
  for (auto _ : state) {
    ++frame;
    benchmark::DoNotOptimize(renderer.Render(
        frame, frame / kFps, {}, {.surfaces = {&surface, 1}, .strokes = {}, .balls = {}}));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(DrawTetrahedra)
    ->ArgNames({"tetrahedra", "moving"})
    ->Args({13'818, 0})
    ->Args({13'818, 1})
    ->Unit(benchmark::kMillisecond);

void ConvertColours(benchmark::State& state) {
  const Image image(1920, 1080);
  std::vector<std::uint8_t> y(1920 * 1080), u(960 * 540), v(960 * 540);
  for (auto _ : state) {
    ConvertToYuv420(image, {{y.data(), u.data(), v.data()}, {1920, 960, 960}});
  }
}
BENCHMARK(ConvertColours)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flocklift
