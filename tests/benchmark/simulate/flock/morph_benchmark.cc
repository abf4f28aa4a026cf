// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Flock morphing with the tetrahedra of the words scene, whole steps with every frame's vertices in
// memory: over the whole animation, and in the worst case, all in flight or all changing shape.

#include <benchmark/benchmark.h>

#include "simulate/core/rng.h"
#include "simulate/flock/flock_morph.h"

namespace flocklift {
namespace {

constexpr int kTetrahedra = 13818;

std::vector<Tetra> Cloud(const Vec3d& centre, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Tetra> cloud;
  while (cloud.size() < kTetrahedra) {
    const Vec3d p =
        centre + Vec3d{2 * rng.Uniform(-1, 1), 10 * rng.Uniform(-1, 1), 4 * rng.Uniform(-1, 1)};
    Tetra t;
    for (Vec3d& corner : t) corner = p + 0.2 * Vec3d{rng.Normal(), rng.Normal(), rng.Normal()};
    if (Volume(t) < 0) std::swap(t[0], t[1]);
    if (ShapeQuality(t) > 0.1) cloud.push_back(t);
  }
  return cloud;
}

MorphScene Scene(double departure_time) {
  MorphScene scene;
  scene.from = Cloud({0, 0, 0}, 1);
  scene.to = Cloud({60, 0, 0}, 2);
  for (int k = 0; k <= 64; ++k) scene.path.push_back({60.0 * k / 64, 0, 0});
  scene.options.departure_time = departure_time;
  scene.options.d_min = 0.1;
  return scene;
}

void BM_WholeAnimation(benchmark::State& state) {
  const MorphScene scene = Scene(4);
  ThreadPool pool(1);
  FlockMorph morph(scene);
  double in_flight = 0;
  for (auto _ : state) {
    if (morph.Done()) {
      state.PauseTiming();
      morph = FlockMorph(scene);
      state.ResumeTiming();
    }
    morph.Step(&pool);
    morph.UpdateVertices(&pool);
    in_flight += static_cast<double>(morph.InFlight());
  }
  state.counters["in_flight"] = in_flight / static_cast<double>(state.iterations());
  state.SetItemsProcessed(state.iterations() * kTetrahedra);
}
BENCHMARK(BM_WholeAnimation)->Unit(benchmark::kMicrosecond);

// Repeats the steps from `start` to `end`, in which nobody waits any more.
void AllFly(benchmark::State& state, double start, double end) {
  const MorphScene scene = Scene(0);
  ThreadPool pool(1);
  FlockMorph fresh(scene);
  while (fresh.time() < start) fresh.Step(&pool);
  FlockMorph morph = fresh;
  for (auto _ : state) {
    if (morph.time() > end) {
      state.PauseTiming();
      morph = fresh;
      state.ResumeTiming();
    }
    morph.Step(&pool);
    morph.UpdateVertices(&pool);
  }
  state.SetItemsProcessed(state.iterations() * kTetrahedra);
}
void BM_AllOnThePath(benchmark::State& state) { AllFly(state, 0.5, 4); }
void BM_AllChangeShape(benchmark::State& state) { AllFly(state, 6.05, 6.2); }
BENCHMARK(BM_AllOnThePath)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_AllChangeShape)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace flocklift
