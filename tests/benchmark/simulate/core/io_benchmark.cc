// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Rows a second of the readers and writers, text and HDF5, full trajectories and tracks.

#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "simulate/core/io.h"
#include "simulate/core/rng.h"

namespace flocklift {
namespace {

constexpr int kAnimals = 200, kFrames = 1000;

std::filesystem::path File(const std::string& name) {
  return std::filesystem::temp_directory_path() /
         ("flocklift_benchmark_" + std::to_string(getpid()) + "_" + name);
}

Tracks SomeTracks() {
  Tracks tracks{.fps = 30, .tracklets = {}};
  for (Id id = 1; id <= kAnimals; ++id) {
    Rng rng(1, static_cast<std::uint64_t>(id));
    Tracklet& tracklet = tracks.tracklets.emplace_back();
    tracklet.id = id;
    for (int frame = 1; frame <= kFrames; ++frame) {
      Detection& detection = tracklet.detections.emplace_back();
      detection.frame = frame;
      detection.box = {rng.Uniform(0, 1920), rng.Uniform(0, 1080), rng.Uniform(5, 50),
                       rng.Uniform(5, 50)};
    }
  }
  return tracks;
}

Trajectories SomeTrajectories() {
  Trajectories flock{.fps = 30,
                     .has_velocity = true,
                     .has_orientation = true,
                     .has_sd_depth = true,
                     .trajectories = {}};
  for (Id id = 1; id <= kAnimals; ++id) {
    Rng rng(2, static_cast<std::uint64_t>(id));
    Trajectory& trajectory = flock.trajectories.emplace_back();
    trajectory.id = id;
    for (int frame = 1; frame <= kFrames; ++frame) {
      TrajectoryPoint& point = trajectory.points.emplace_back();
      point.frame = frame;
      point.position = {rng.Uniform(-50, 50), rng.Uniform(-50, 50), rng.Uniform(2, 50)};
      point.velocity = {rng.Normal(), rng.Normal(), rng.Normal()};
      point.world_from_body = {0.6, 0, 0, 0.8};
      point.sd_depth = rng.Uniform();
    }
  }
  return flock;
}

void Finish(benchmark::State* state, const std::filesystem::path& path) {
  state->SetItemsProcessed(state->iterations() * kAnimals * kFrames);
  std::filesystem::remove(path);
}

void BM_ReadTracks(benchmark::State& state, const std::string& name) {
  const std::filesystem::path path = File(name);
  WriteTracks(path, SomeTracks());
  for (auto _ : state) benchmark::DoNotOptimize(ReadTracks(path));
  Finish(&state, path);
}

void BM_WriteTracks(benchmark::State& state, const std::string& name) {
  const std::filesystem::path path = File(name);
  const Tracks tracks = SomeTracks();
  for (auto _ : state) WriteTracks(path, tracks);
  Finish(&state, path);
}

void BM_ReadTrajectories(benchmark::State& state, const std::string& name) {
  const std::filesystem::path path = File(name);
  WriteTrajectories(path, SomeTrajectories());
  for (auto _ : state) benchmark::DoNotOptimize(ReadTrajectories(path));
  Finish(&state, path);
}

void BM_WriteTrajectories(benchmark::State& state, const std::string& name) {
  const std::filesystem::path path = File(name);
  const Trajectories flock = SomeTrajectories();
  for (auto _ : state) WriteTrajectories(path, flock);
  Finish(&state, path);
}

BENCHMARK_CAPTURE(BM_ReadTracks, text, std::string("tracks.csv"))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_ReadTracks, hdf5, std::string("tracks.h5"))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_WriteTracks, text, std::string("tracks.csv"))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_WriteTracks, hdf5, std::string("tracks.h5"))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_ReadTrajectories, text, std::string("flock.csv"))
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_ReadTrajectories, hdf5, std::string("flock.h5"))
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_WriteTrajectories, text, std::string("flock.csv"))
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_WriteTrajectories, hdf5, std::string("flock.h5"))
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flocklift
