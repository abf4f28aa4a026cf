// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What depth costs: CPU time of a method per bird and frame on the circling twin, one thread. The
// arguments are birds and frames; the published method (cobyla) is there to compare with.

#include <benchmark/benchmark.h>

#include <algorithm>

#include "reconstruct/reconstruct.h"
#include "tools/depth_case.h"

namespace flocklift {
namespace {

const DepthCase& Circling() {
  return *std::find_if(DepthCases().begin(), DepthCases().end(),
                       [](const DepthCase& c) { return c.scene == "circling"; });
}

void Solve(benchmark::State& state, ReconstructMethod method) {
  DepthTwin twin = MakeDepthTwin(Circling(), FLOCKLIFT_SOURCE_DIR "/data_synthetic",
                                 static_cast<int>(state.range(0)), 1, 1);
  double rows = 0;
  for (Tracklet& tracklet : twin.tracks.tracklets) {
    std::erase_if(tracklet.detections,
                  [&](const Detection& d) { return d.frame > state.range(1); });
    rows += static_cast<double>(tracklet.detections.size());
  }
  std::erase_if(twin.tracks.tracklets, [](const Tracklet& t) { return t.detections.empty(); });
  ReconstructOptions options;
  options.method = method;
  options.knowledge = twin.knowledge;
  for (auto _ : state) {
    benchmark::DoNotOptimize(Reconstruct(options, twin.tracks, twin.camera, twin.fps, 1, {}));
  }
  state.counters["per_bird_frame"] =
      benchmark::Counter(rows * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void ByBirdsAndFrames(benchmark::internal::Benchmark* benchmark) {
  for (const int birds : {20, 50, 100, 200}) benchmark->Args({birds, 300});
  for (const int frames : {75, 150}) benchmark->Args({20, frames});
  benchmark->ArgNames({"birds", "frames"})->Unit(benchmark::kMillisecond)->Iterations(1);
}
BENCHMARK_CAPTURE(Solve, batch, ReconstructMethod::kBatch)->Apply(ByBirdsAndFrames);
BENCHMARK_CAPTURE(Solve, dynamics, ReconstructMethod::kDynamics)->Apply(ByBirdsAndFrames);
BENCHMARK_CAPTURE(Solve, cobyla, ReconstructMethod::kCobyla)
    ->Args({20, 300})
    ->ArgNames({"birds", "frames"})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

}  // namespace
}  // namespace flocklift
