// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The shape-constrained swarm on one thread: whole steps of a swarm that has formed a sphere, with
// the neighbour cap and with the published radii, which reach everybody. Chen et al. 2019: 38, 35
// and 34 frames/s of 10 000 insects.
//   simulate_flock_shape_benchmark --benchmark_min_time=0.5

#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "simulate/core/rng.h"
#include "simulate/flock/engine.h"
#include "simulate/shapes/solid_meshes.h"

namespace flocklift {
namespace {

constexpr double kSpacing = 0.3;  // of the samples [m]

// range(0) animals, range(1) neighbours at most; 0: all.
void Step(benchmark::State& state) {
  const auto animals = static_cast<int>(state.range(0));
  const double radius = kSpacing * std::sqrt(animals / (4 * std::numbers::pi));
  World world;
  world.dt = 1.0 / 30;
  world.shapes.push_back({"ball", {0}, {BallMesh({}, radius, 4)}, 0, ""});
  Swarm swarm;
  swarm.species = "fly";
  swarm.shape = "ball";
  ShapeParameters p;
  p.neighbours = static_cast<double>(state.range(1));
  swarm.model = p;
  Rng rng(5);
  for (int k = 0; k < animals; ++k) {
    const Vec3d way{rng.Normal(), rng.Normal(), rng.Normal()};
    swarm.position.push_back(radius * rng.Uniform(0.9, 1.1) * Normalized(way));
    swarm.velocity.push_back({0.1 * rng.Normal(), 0.1 * rng.Normal(), 0.1 * rng.Normal()});
  }
  Engine engine(world, {swarm}, {});
  for (int k = 0; k < (p.neighbours > 0 ? 200 : 1); ++k) engine.Step();
  for (auto unused : state) engine.Step();
  state.counters["neighbours"] = engine.MeanNeighbours();
  state.counters["mde_share"] = engine.MdeShare();
  state.counters["steps"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(Step)
    ->ArgNames({"animals", "neighbours"})
    ->Args({5000, 8})
    ->Args({10000, 8})
    ->Args({10000, 16})
    ->Args({20000, 8})
    ->Args({10000, 32})
    ->Args({10000, 0})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flocklift
