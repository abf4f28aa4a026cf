// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One frame of prediction, gating, assignment and update, against the number of animals at a fixed
// density (100 px between neighbours).

#include "track/associate/flock_tracker.h"

#include <benchmark/benchmark.h>

#include <cmath>

#include "tests/track/pictures.h"

namespace flocklift {
namespace {

void BM_Step(benchmark::State& state) {
  const int count = static_cast<int>(state.range(0));
  const double side = 100 * std::sqrt(static_cast<double>(count));
  const MotionNoise noise{.acceleration = 0.05, .measurement = 0.05, .speed_sd = 5};
  std::vector<BlobFrame> frames;
  for (int frame = 1; frame <= 40; ++frame) {
    std::vector<SoftBlob> blobs;
    for (int k = 0; k < count; ++k) {
      Rng rng(1, static_cast<std::uint64_t>(k));
      const Vec2d p{rng.Uniform(0, side), rng.Uniform(0, side)};
      const Vec2d v{rng.Uniform(-4, 4), rng.Uniform(-4, 4)};
      blobs.push_back({.center = {p.x + v.x * frame, p.y + v.y * frame}});
    }
    frames.push_back(BlobsOf(frame, blobs));
  }
  for (auto _ : state) {
    FlockTracker tracker({}, noise, side, side);
    for (const BlobFrame& frame : frames) tracker.Step(frame);
    benchmark::DoNotOptimize(tracker.Finish());
  }
  const double steps = static_cast<double>(state.iterations() * 40);
  state.counters["frames/s"] = benchmark::Counter(steps, benchmark::Counter::kIsRate);
  state.counters["time_per_animal"] =
      benchmark::Counter(steps * count, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(BM_Step)->RangeMultiplier(4)->Range(20, 5120)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flocklift
