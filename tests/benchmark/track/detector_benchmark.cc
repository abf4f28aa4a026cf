// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Detection of one frame: 720p and 1080p, few and many animals.

#include "track/detect/detector.h"

#include <benchmark/benchmark.h>

#include "tests/track/pictures.h"

namespace flocklift {
namespace {

void BM_Detect(benchmark::State& state) {
  const int height = static_cast<int>(state.range(0)), width = height * 16 / 9;
  std::vector<SoftBlob> blobs;
  Rng rng(1);
  for (int k = 0; k < state.range(1); ++k) {
    blobs.push_back({.center = {rng.Uniform(0, width), rng.Uniform(0, height)},
                     .contrast = -90,
                     .major_sd = 3,
                     .minor_sd = 1.5,
                     .angle_deg = rng.Uniform(0, 180)});
  }
  const GrayImage image =
      DrawPicture(width, height, {.level = 150, .gradient_y = 0.05, .noise = 3}, blobs);
  Detector detector({});
  ThreadPool pool(1);
  detector.Learn(std::span(&image, 1), &pool);
  for (auto _ : state) benchmark::DoNotOptimize(detector.Detect(1, image));
  state.counters["frames/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(BM_Detect)
    ->Args({720, 30})
    ->Args({720, 500})
    ->Args({1080, 30})
    ->Args({1080, 1000})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flocklift
