// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The stepping of whole scenes of data_synthetic/, from their first frame to their last, as phase
// `step` of the summary times it, on one thread. An iteration is a whole scene. `steps/s` is what
// they took on average; `quiet` adds up the least time that each step took in all iterations, which
// a busy machine disturbs less (use --benchmark_min_time=10).

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <limits>
#include <string>
#include <vector>

#include "simulate/core/scene_io.h"
#include "simulate/flock/engine.h"
#include "simulate/flock/population.h"

namespace flocklift {
namespace {

double CpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void Stepping(benchmark::State& state, const std::string& name) {
  const Scene scene = ReadScene(FLOCKLIFT_SOURCE_DIR "/data_synthetic/" + name + ".toml");
  const Population population = Populate(scene);
  Engine engine(population.world, population.swarms, EngineOptions{.threads = 1, .kernel = {}});
  const auto warmup = static_cast<std::int64_t>(scene.warmup * scene.fps) * scene.substeps;
  for (std::int64_t k = 0; k < warmup; ++k) engine.Step();
  const std::string start = engine.Save();
  const std::int64_t steps = (scene.FrameCount() - 1) * scene.substeps;
  std::vector<double> least(static_cast<std::size_t>(steps), std::numeric_limits<double>::max());
  for (auto _ : state) {
    double sum = 0;
    engine.Load(start);
    for (double& quickest : least) {
      const double before = CpuSeconds();
      engine.Step();
      const double took = CpuSeconds() - before;
      quickest = std::min(quickest, took);
      sum += took;
    }
    state.SetIterationTime(sum);
  }
  double quiet = 0;
  for (const double quickest : least) quiet += quickest;
  state.SetItemsProcessed(state.iterations() * steps);
  state.counters["quiet"] = static_cast<double>(steps) / quiet;
}
BENCHMARK_CAPTURE(Stepping, locusts, "locusts")->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Stepping, locusts_256k, "locusts_256k")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Stepping, moon_10k, "moon_10k")->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Stepping, words, "words")->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Stepping, boids_10k, "bench_boids_10k")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Stepping, boids_100k, "bench_boids_100k")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flocklift
