// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The noise-aware swarm on one thread, per agent and step: the scenes of data_synthetic/ from
// beginning to end, whole steps; their preparation (distances, costs); and the parts of a step,
// which are curl noise, curl noise and guide (a grid of the size that the locusts have), and
// minimum-distance enforcement where about one animal in a hundred is touched, both for animals in
// no order.
//   simulate_flock_swarm_benchmark --benchmark_min_time=0.3

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/core/scene_io.h"
#include "simulate/flock/engine.h"
#include "simulate/flock/kernels/swarm_kernel.h"
#include "simulate/flock/minimum_distance.h"
#include "simulate/flock/population.h"

namespace flocklift {
namespace {

constexpr int kNx = 120, kNy = 50, kNz = 55;  // cells, one a metre

struct Columns {
  std::vector<float> x, y, z, vx, vy, vz, distance;
};
Columns Uniform(std::size_t animals) {
  Columns swarm;
  Rng rng(1);
  for (auto* column :
       {&swarm.x, &swarm.y, &swarm.z, &swarm.vx, &swarm.vy, &swarm.vz, &swarm.distance}) {
    column->resize(animals + 16);
  }
  for (std::size_t k = 0; k < animals; ++k) {
    swarm.x[k] = static_cast<float>(rng.Uniform(1, kNx - 2));
    swarm.y[k] = static_cast<float>(rng.Uniform(1, kNy - 2));
    swarm.z[k] = static_cast<float>(rng.Uniform(1, kNz - 2));
  }
  return swarm;
}

void CountAgents(benchmark::State& state) {
  state.counters["per_agent"] = benchmark::Counter(
      static_cast<double>(state.range(0)),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void Velocities(benchmark::State& state, SwarmKernel kernel, bool guided) {
  const auto animals = static_cast<std::size_t>(state.range(0));
  Columns s = Uniform(animals);
  std::vector<std::int8_t> cells(
      guided ? static_cast<std::size_t>(kGuideCellBytes) * kNx * kNy * kNz : 0, 60);
  const SwarmNoise noise{1.0F, 0.6F, 3};
  const SwarmGuide guide{guided ? cells.data() : nullptr, 0, 0, 0, 1, kNx, kNy, kNz, 8, 4};
  const SwarmJob job{s.x.data(),  s.y.data(),  s.z.data(),  &noise,           1, true, guide,
                     s.vx.data(), s.vy.data(), s.vz.data(), s.distance.data()};
  for (auto _ : state) {
    kernel(job, 0, static_cast<std::uint32_t>(animals));
    benchmark::ClobberMemory();
  }
  CountAgents(state);
}

void Enforce(benchmark::State& state) {
  const auto animals = static_cast<std::size_t>(state.range(0));
  Columns s = Uniform(animals);
  // Of a Poisson gas of density n the share n 4/3 pi d^3 is nearer to somebody than d.
  const double density = static_cast<double>(animals) / (kNx * kNy * kNz);
  const auto room = static_cast<float>(0.5 * std::cbrt(0.01 / (density * 4.19)));
  const std::vector<Crowd<float>> crowds = {
      {animals, s.x.data(), s.y.data(), s.z.data(), room, nullptr}};
  const Columns start = s;
  ThreadPool pool(1);
  MinimumDistance<float> enforcement;
  double touched = 0;
  for (auto _ : state) {
    touched = static_cast<double>(enforcement.Enforce(crowds, &pool));
    s.x = start.x;  // the same pairs every time; the copy is part of what is timed
    s.y = start.y;
    s.z = start.z;
  }
  state.counters["touched"] = touched / static_cast<double>(animals);
  CountAgents(state);
}

Scene SceneOf(const std::string& name) {
  return ReadScene(std::string(FLOCKLIFT_SOURCE_DIR "/data_synthetic/") + name + ".toml");
}

void Prepare(benchmark::State& state, const std::string& scene) {
  const Population population = Populate(SceneOf(scene));
  for (auto _ : state) {
    Engine engine(population.world, population.swarms, {});
    benchmark::DoNotOptimize(engine);
  }
}

void Step(benchmark::State& state, const std::string& scene, int threads) {
  const Population population = Populate(SceneOf(scene));
  Engine engine(population.world, population.swarms, {.threads = threads, .kernel = ""});
  for (auto _ : state) engine.Step();
  state.counters["steps_per_s"] =
      benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["mde_share"] = engine.MdeShare();
  state.counters["per_agent"] = benchmark::Counter(
      static_cast<double>(population.animals.size()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void RegisterAll() {
  for (const std::string scene :
       {"two_blocks", "two_blocks_free", "chasing", "aggregation", "aggregation_800", "phototaxis",
        "phototaxis_300", "locusts", "opposing_swarms", "locusts_256k"}) {
    const Scene read = SceneOf(scene);
    benchmark::RegisterBenchmark(("step/" + scene).c_str(),
                                 [scene](benchmark::State& s) { Step(s, scene, 1); })
        ->Unit(benchmark::kMicrosecond)
        ->Iterations(read.FrameCount() * read.substeps);
  }
  for (const std::string scene : {"two_blocks", "locusts"}) {
    benchmark::RegisterBenchmark(("prepare/" + scene).c_str(), [scene](benchmark::State& s) {
      Prepare(s, scene);
    })->Unit(benchmark::kMillisecond);
  }
  for (const int threads : {1, 2}) {
    benchmark::RegisterBenchmark(
        ("threads/locusts_256k/" + std::to_string(threads)).c_str(),
        [threads](benchmark::State& s) { Step(s, "locusts_256k", threads); })
        ->Unit(benchmark::kMicrosecond)
        ->UseRealTime()
        ->Iterations(60);
  }
  const auto add = [](const std::string& name, const auto& run) {
    auto* const one = benchmark::RegisterBenchmark(name.c_str(), run);
    one->ArgName("agents")->Unit(benchmark::kMicrosecond)->Arg(5000)->Arg(256000);
  };
  const auto add_kernel = [&add](const std::string& name, SwarmKernel kernel) {
    add("curl/" + name, [kernel](benchmark::State& s) { Velocities(s, kernel, false); });
    add("curl_and_guide/" + name, [kernel](benchmark::State& s) { Velocities(s, kernel, true); });
  };
  add_kernel("scalar", SwarmKernelScalar);
  for (const SwarmKernelVariant& variant : kSwarmKernels) {
    if (variant.supported()) add_kernel(variant.name, variant.kernel);
  }
  add("minimum_distance", Enforce);
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
