// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The whole boids step (sort by cell, forces, integration) on one thread, per agent and step, for
// every kernel variant of the machine; `scalar` is the plain loop over pairs. Agents are uniform in
// a cube of 1 agent per cubic metre, sight 1.93 m, separation 1 m, rules of the UCSD assignment;
// they hardly move, so the flock stays as it is.
//   simulate_flock_boids_benchmark --benchmark_min_time=0.3

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/flock/engine.h"
#include "simulate/flock/kernels/kernels.h"

namespace flocklift {
namespace {

Swarm UniformCube(int agents) {
  BoidsParameters<double> p;
  p.d_s = 1;
  p.d_v = 1.93;
  p.alpha_s = 0.02;
  p.alpha_c = 0.001;
  p.alpha_a = 0.03;
  p.alpha_b = p.cruise = p.level = p.noise = 0;
  p.s_min = 0.05;
  p.s_max = 0.1;
  Swarm swarm{"agent", p, {}, {}, {}};
  const double edge = std::cbrt(agents);
  Rng rng(1);
  for (int k = 0; k < agents; ++k) {
    swarm.position.push_back({rng.Uniform(0, edge), rng.Uniform(0, edge), rng.Uniform(0, edge)});
    swarm.velocity.push_back({0.04 * rng.Normal(), 0.04 * rng.Normal(), 0.04 * rng.Normal()});
  }
  return swarm;
}

void Step(benchmark::State& state, const std::string& kernel) {
  World world;
  world.dt = 1e-3;
  Engine engine(world, {UniformCube(static_cast<int>(state.range(0)))},
                {.threads = static_cast<int>(state.range(1)), .kernel = kernel});
  for (auto _ : state) engine.Step();
  state.counters["neighbours"] = engine.MeanNeighbours();
  state.counters["per_agent"] = benchmark::Counter(
      static_cast<double>(state.range(0)),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void RegisterAll() {
  std::vector<std::string> kernels = {"scalar"};
  for (const KernelVariant* variant : kKernels) {
    if (variant->supported()) kernels.emplace_back(variant->name);
  }
  for (const std::string& kernel : kernels) {
    auto* const one = benchmark::RegisterBenchmark(("boids_step/" + kernel).c_str(), Step, kernel);
    one->ArgNames({"agents", "threads"})->Unit(benchmark::kMicrosecond);
    one->Args({10000, 1})->Args({100000, 1});
    if (kernel != "scalar") one->Args({1000000, 1});
  }
  auto* const two = benchmark::RegisterBenchmark("boids_step/two_threads", Step, kernels.back());
  two->ArgNames({"agents", "threads"})->Unit(benchmark::kMicrosecond)->UseRealTime();
  two->Args({10000, 1})->Args({10000, 2})->Args({100000, 1})->Args({100000, 2});
}

}  // namespace
}  // namespace flocklift

int main(int argc, char** argv) {
  flocklift::RegisterAll();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
