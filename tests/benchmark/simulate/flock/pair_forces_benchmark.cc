// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The forces between pairs alone (one thread, per agent), for every rule set and kernel variant of
// the machine; `scalar` is the plain loop over pairs of the same cell grid, the only peer of
// OpenSteer's rules that needs nothing from elsewhere. Agents are uniform in a cube of 1 per cubic
// metre, reach 1.93 m: about 28 neighbours. zones_capped is the published radii, at which nearly
// all are neighbours, with a sample of about 32.
//   simulate_flock_pair_forces_benchmark --benchmark_min_time=0.3

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/flock/orca.h"
#include "simulate/flock/pair_forces.h"

namespace flocklift {
namespace {

constexpr double kReach = 1.93;

Bodies<float> UniformCube(std::size_t agents) {
  Bodies<float> bodies;
  bodies.Resize(agents);
  const double edge = std::cbrt(static_cast<double>(agents));
  Rng rng(1);
  const auto f = [](double value) { return static_cast<float>(value); };
  for (std::size_t k = 0; k < agents; ++k) {
    const Vec3d v = Normalized({rng.Normal(), rng.Normal(), rng.Normal()});
    const double x = rng.Uniform(0, edge), y = rng.Uniform(0, edge), z = rng.Uniform(0, edge);
    bodies.Set(k, {f(x), f(y), f(z)}, {f(v.x), f(v.y), f(v.z)});
    bodies.agent[k] = static_cast<std::uint32_t>(k);
  }
  return bodies;
}

void PerAgent(benchmark::State& state, double neighbours) {
  state.counters["neighbours"] = neighbours;
  state.counters["per_agent"] = benchmark::Counter(
      static_cast<double>(state.range(0)),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <typename Parameters>
void Sum(benchmark::State& state, const std::string& kernel, const Parameters& p,
         std::uint32_t most) {
  const auto n = static_cast<std::size_t>(state.range(0));
  CellGrid<float> grid;
  Bodies<float> sorted;
  grid.Sort(UniformCube(n), Reach(p), &sorted);
  std::vector<RowSample> sample;
  if (most > 0) SampleRows(grid, most, 0, &sample);
  std::vector<float> columns[4];
  for (std::vector<float>& column : columns) column.resize(n + Bodies<float>::kPadding);
  ThreadPool pool(1);
  const PairTask<float> task{
      grid, sorted, columns[0], columns[1], columns[2], columns[3], most > 0 ? &sample : nullptr};
  for (auto _ : state) SumPairs<float>(p, ChooseKernel(kernel), task, &pool);
  double neighbours = 0;
  for (std::size_t k = 0; k < n; ++k) neighbours += static_cast<double>(columns[3][k]);
  PerAgent(state, neighbours / static_cast<double>(n));
}

// From lists that were made before, as those of a flock that moves little; the rows of the animals
// are filled and looked through for moves each time.
template <typename Parameters>
void SumKept(benchmark::State& state, const std::string& kernel, const Parameters& p) {
  const auto n = static_cast<std::size_t>(state.range(0));
  Herd<float> herd;
  herd.now = UniformCube(n);
  for (std::vector<float>* column : {&herd.ax, &herd.ay, &herd.az, &herd.neighbours}) {
    column->resize(n + Bodies<float>::kPadding);
  }
  ThreadPool pool(1);
  VerletLists<float> lists(kListSkin);
  const NearReach<float> reach{static_cast<float>(Reach(p)), 0};
  const KernelVariant* const chosen = ChooseKernel(kernel);
  lists.Update(reach, chosen, &pool, &herd);
  PairTask<float> task = TaskOf(&herd);
  task.lists = &lists;
  for (auto _ : state) {
    lists.Update(reach, chosen, &pool, &herd);
    SumPairs<float>(p, chosen, task, &pool);
  }
  double neighbours = 0;
  for (std::size_t k = 0; k < n; ++k) neighbours += static_cast<double>(herd.neighbours[k]);
  PerAgent(state, neighbours / static_cast<double>(n));
}

void Sort(benchmark::State& state) {
  CellGrid<float> grid;
  Bodies<float> now = UniformCube(static_cast<std::size_t>(state.range(0))), sorted;
  for (auto _ : state) {
    grid.Sort(now, kReach, &sorted);
    std::swap(now, sorted);
  }
  PerAgent(state, 0);
}

// Crowded: each avoids its 16 nearest.
void Orca(benchmark::State& state) {
  const auto n = static_cast<std::size_t>(state.range(0));
  CellGrid<float> grid;
  Bodies<float> sorted;
  grid.Sort(UniformCube(n), kReach, &sorted);
  const std::vector<float> radius(n, 0.2F);
  const OrcaOptions options{.horizon = 1, .max_speed = 1.2, .sight = kReach, .most_neighbours = 16};
  std::vector<Vec3<float>> velocities(n);
  ThreadPool pool(1);
  for (auto _ : state) {
    for (std::size_t k = 0; k < n; ++k) velocities[k] = sorted.Velocity(k);
    AvoidCollisions(options, 1.0 / 60, grid, sorted, radius, {}, &pool, &velocities);
  }
  PerAgent(state, options.most_neighbours);
}

void RegisterAll() {
  BoidsParameters<double> boids;
  boids.d_s = 1;
  boids.d_v = kReach;
  BoidsParameters<double> blind = boids;
  blind.blind = 1.5;
  const ZoneParameters zones{0.3 * kReach, 0.6 * kReach, kReach, 0.2, 3, 13, 0};
  const ZoneParameters wide{0.3, 10, 30, 0.2, 3, 13, 0};
  SteerParameters steer;
  steer.separation.radius = 5.0 / 9 * kReach;
  steer.alignment.radius = 7.5 / 9 * kReach;
  steer.cohesion.radius = kReach;
  steer.near = 1.5 / 9 * kReach;
  const auto add = [](const std::string& name, const auto& fn) {
    benchmark::RegisterBenchmark(name.c_str(), fn)
        ->Unit(benchmark::kMicrosecond)
        ->Arg(10000)
        ->Arg(100000);
  };
  std::vector<std::string> kernels = {"scalar"};
  for (const KernelVariant* variant : kKernels) {
    if (variant->supported()) kernels.emplace_back(variant->name);
  }
  for (const std::string& kernel : kernels) {
    const auto sum = [&](const std::string& name, const auto& p, std::uint32_t most) {
      add(name + "/" + kernel, [=](benchmark::State& state) { Sum(state, kernel, p, most); });
    };
    sum("boids", boids, 0);
    sum("boids_blind", blind, 0);
    sum("zones", zones, 0);
    sum("opensteer", steer, 0);
    const auto kept = [&](const std::string& name, const auto& p) {
      add(name + "_kept/" + kernel, [=](benchmark::State& state) { SumKept(state, kernel, p); });
    };
    kept("boids", boids);
    kept("zones", zones);
    if (kernel != "scalar") sum("zones_capped", wide, 32);
  }
  add("sort", Sort);
  add("orca", Orca);
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
