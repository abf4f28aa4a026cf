// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The state-space estimate of the reference flock (equations.md 2b), one seed an iteration: time a
// fit, and over the seeds each weight's rms error, that of least squares on the true velocities of
// the same seeds, how many of the 95 % intervals cover, and the rms of errors in their stated sd.
// The argument is the sd of position noise [um].

#include <benchmark/benchmark.h>

#include <cmath>

#include "reconstruct/fit/state_space.h"
#include "tests/reconstruct/fit/flocks.h"
#include "tests/reconstruct/fit/linear_flock.h"

namespace flocklift {
namespace {

constexpr double kTruth[] = {LinearFlock::kCohesion, LinearFlock::kAlignment};
constexpr const char* kNames[] = {"cohesion", "alignment"};

void FitReferenceFlock(benchmark::State& state) {
  const double noise = 1e-6 * static_cast<double>(state.range(0));
  ModelSpec model;
  model.name = "linear";
  const ProcessModel process = MakeProcessModel(model, {kNames[0], kNames[1]});
  double squares[2]{}, of_truth[2]{}, covered[2]{}, in_sd[2]{};
  std::uint64_t seed = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const LinearFlock flock = FlyLinearFlock(++seed);
    const Trajectories seen = WithNoise(flock.seen, noise, 1000 + seed);
    state.ResumeTiming();
    const FilterInput input(ObservedFlock(seen, seen.fps.value(), 5));
    const StateSpaceFit fit = FitStateSpace({}, process, {0, 0}, input);
    for (std::size_t p = 0; p < 2; ++p) {
      const double error = fit.estimate[p] - kTruth[p];
      squares[p] += std::pow(error / kTruth[p], 2);
      of_truth[p] += std::pow(flock.from_true_velocities[p] / kTruth[p] - 1, 2);
      in_sd[p] += std::pow(error / fit.sd[p], 2);
      covered[p] += std::abs(error) < 1.96 * fit.sd[p] ? 1 : 0;
    }
  }
  const auto seeds = static_cast<double>(seed);
  for (std::size_t p = 0; p < 2; ++p) {
    const std::string name = kNames[p];
    state.counters[name + "_%"] = 100 * std::sqrt(squares[p] / seeds);
    state.counters[name + "_ratio"] = std::sqrt(squares[p] / of_truth[p]);
    state.counters[name + "_cover_%"] = 100 * covered[p] / seeds;
    state.counters[name + "_in_sd"] = std::sqrt(in_sd[p] / seeds);
  }
}
BENCHMARK(FitReferenceFlock)
    ->Arg(0)
    ->Arg(100)
    ->Arg(300)
    ->Arg(1000)
    ->Iterations(200)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flocklift
