// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is computed before a swarm flies through a village: signed distances to its meshes and the
// cost field to one goal, on the 120 x 50 x 55 nodes of the locust scene; then the cost field when
// the goal moves, or one of several, and one look-up of a direction. One thread unless said.
//   simulate_fields_fields_benchmark --benchmark_min_time=0.5

#include <benchmark/benchmark.h>

#include <vector>

#include "simulate/core/rng.h"
#include "simulate/fields/cost_field.h"
#include "simulate/fields/distance_field.h"
#include "tests/simulate/fields/meshes.h"

namespace flocklift {
namespace {

const Grid kGrid{{0, 0, 0}, 1, 120, 50, 55};

// Twelve houses with domes, trees, and towers: 8240 triangles in 32 meshes; and the same in one.
TriangleMesh VillagePart(int k) {
  const double x = 8 + 9.5 * (k % 12), y = 10 + 14 * ((k * 7) % 3);
  if (k < 12) return BoxMesh({x, y, 0}, {x + 6, y + 5, 8.0 + k});
  if (k < 24) return BallMesh({x + 5, y + 8, 14}, 4, 12, 20, 0.2);
  TriangleMesh ring = TorusMesh(4, 1, 20, 8);
  for (Vec3d& v : ring.vertices) v += {x, y, 35};
  return ring;
}

std::vector<Solid> Village(bool joined) {
  std::vector<Solid> solids;
  TriangleMesh all;
  for (int k = 0; k < 32; ++k) {
    if (joined) {
      Append(VillagePart(k), &all);
    } else {
      solids.emplace_back(MeshDistance(VillagePart(k)));
    }
  }
  if (joined) solids.emplace_back(MeshDistance(all));
  return solids;
}

void CountTriangles(benchmark::State& state) {
  std::size_t triangles = 0;
  for (int k = 0; k < 32; ++k) triangles += VillagePart(k).triangles.size();
  state.counters["triangles"] = static_cast<double>(triangles);
}

std::vector<Solid> Goals(double x) { return {Ball{{x, 25, 20}, 3}}; }

// All of it, from the meshes.
void Preprocess(benchmark::State& state) {
  for (auto _ : state) {
    const ScalarField distance = DistanceField(kGrid, Village(state.range(0) != 0));
    const CostField field(distance, {}, Goals(115));
    benchmark::DoNotOptimize(field.guide().data());
  }
  CountTriangles(state);
}

void Distance(benchmark::State& state) {
  const std::vector<Solid> solids = Village(state.range(0) != 0);
  for (auto _ : state) {
    benchmark::DoNotOptimize(DistanceField(kGrid, solids, static_cast<int>(state.range(1))));
  }
  CountTriangles(state);
}

const ScalarField& VillageDistance() {
  static const ScalarField distance = DistanceField(kGrid, Village(false));
  return distance;
}

void Cost(benchmark::State& state) {
  for (auto _ : state) {
    const CostField field(VillageDistance(), {}, Goals(115), static_cast<int>(state.range(0)));
    benchmark::DoNotOptimize(field.guide().data());
  }
}

// A chase: the only goal moves by half a spacing.
void MovedGoal(benchmark::State& state) {
  CostField field(VillageDistance(), {}, Goals(115));
  double x = 115;
  for (auto _ : state) {
    x = x == 115 ? 114.5 : 115;
    field.SetGoals(Goals(x));
    field.CoverAll();
  }
}

// One of sixteen goals moves.
void MovedGoalOfMany(benchmark::State& state) {
  std::vector<Solid> goals;
  Rng rng(4);
  for (int k = 0; k < 16; ++k) {
    goals.emplace_back(Ball{{rng.Uniform(0, 119), rng.Uniform(0, 49), rng.Uniform(20, 54)}, 2});
  }
  CostField field(VillageDistance(), {}, goals);
  Ball& goal = std::get<Ball>(goals[3]);
  const double x = goal.centre.x;
  for (auto _ : state) {
    goal.centre.x = goal.centre.x == x ? x + 0.5 : x;
    field.SetGoals(goals);
    field.CoverAll();
  }
}

void Direction(benchmark::State& state) {
  const CostField field(VillageDistance(), {}, Goals(115));
  Rng rng(1);
  std::vector<Vec3d> points(4096);
  for (Vec3d& p : points) p = {rng.Uniform(0, 119), rng.Uniform(0, 49), rng.Uniform(0, 54)};
  std::size_t k = 0;
  for (auto _ : state) benchmark::DoNotOptimize(field.Direction(points[++k % points.size()]));
}

BENCHMARK(Preprocess)->ArgName("joined")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(Distance)
    ->ArgNames({"joined", "threads"})
    ->Args({0, 1})
    ->Args({1, 1})
    ->Args({0, 2})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(Cost)->ArgName("threads")->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(MovedGoal)->Unit(benchmark::kMillisecond);
BENCHMARK(MovedGoalOfMany)->Unit(benchmark::kMillisecond);
BENCHMARK(Direction);

}  // namespace
}  // namespace flocklift
