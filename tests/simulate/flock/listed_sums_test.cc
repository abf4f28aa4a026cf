// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/listed_sums.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/flock/engine.h"
#include "tests/simulate/flock/pair_sums.h"

namespace flocklift {
namespace {

// A flock whose lists were made before everybody moved a little: some hold strangers.
template <typename T>
class ListedFlock {
 public:
  ListedFlock(const NamedFlock& flock, double reach, const std::string& kernel)
      : kernel_(ChooseKernel(kernel)) {
    herd_.now = AsBodies<T>(flock);
    for (std::vector<T>* column : {&herd_.ax, &herd_.ay, &herd_.az, &herd_.neighbours}) {
      column->assign(herd_.size() + Bodies<T>::kPadding, T(-1));
    }
    const NearReach<T> wanted{static_cast<T>(reach), T(0)};
    lists_.Update(wanted, kernel_, &pool_, &herd_);
    const std::vector<std::uint32_t> order = herd_.now.agent;
    for (std::size_t k = 0; k < herd_.size(); ++k) {
      Rng rng(41 + herd_.now.agent[k]);
      const Vec3d step = Vec3d{rng.Uniform(-1, 1), rng.Uniform(-1, 1), rng.Uniform(-1, 1)};
      herd_.now.Set(k, herd_.now.Position(k) + Cast<T>(0.08 * reach * step), herd_.now.Velocity(k));
    }
    lists_.Update(wanted, kernel_, &pool_, &herd_);
    EXPECT_EQ(herd_.now.agent, order);  // kept
  }

  const Bodies<T>& bodies() const { return herd_.now; }

  template <typename Parameters>
  ByAnimal Sum(const Parameters& p) {
    PairTask<T> task = TaskOf(&herd_);
    task.lists = &lists_;
    SumPairs<T>(p, kernel_, task, &pool_);
    ByAnimal result{std::vector<Vec3d>(herd_.size()), std::vector<double>(herd_.size())};
    for (std::size_t k = 0; k < herd_.size(); ++k) {
      result.acceleration[herd_.now.agent[k]] = ToDouble(herd_.Acceleration(k));
      result.neighbours[herd_.now.agent[k]] = static_cast<double>(herd_.neighbours[k]);
    }
    return result;
  }

 private:
  const KernelVariant* kernel_;
  ThreadPool pool_{2};
  Herd<T> herd_;
  VerletLists<T> lists_{0.4};
};

// By the grid, which is held against brute force elsewhere (pair_forces_test.cc).
template <typename Parameters>
ByAnimal ByGrid(const Bodies<double>& bodies, const Parameters& p) {
  NamedFlock flock{"", {}, {}};
  flock.position.resize(bodies.size());
  flock.velocity.resize(bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    flock.position[bodies.agent[k]] = bodies.Position(k);
    flock.velocity[bodies.agent[k]] = bodies.Velocity(k);
  }
  return SortedFlock<double>(flock, Reach(p)).Sum(p, "scalar");
}

template <typename Parameters>
void ExpectSumsOfTheGrid(const Parameters& p) {
  for (const NamedFlock& flock : ManyFlocks()) {
    SCOPED_TRACE(flock.name);
    ListedFlock<double> listed(flock, Reach(p), "scalar");
    const ByAnimal actual = listed.Sum(p), expected = ByGrid(listed.bodies(), p);
    EXPECT_EQ(actual.neighbours.size(), expected.neighbours.size());
    for (std::size_t k = 0; k < expected.neighbours.size(); ++k) {
      EXPECT_NEAR(actual.neighbours[k], expected.neighbours[k], 1e-9) << k;
      EXPECT_LE(Norm(actual.acceleration[k] - expected.acceleration[k]),
                1e-9 * (1 + Norm(expected.acceleration[k])))
          << k;
    }
    const ByAnimal scalar = ListedFlock<float>(flock, Reach(p), "scalar").Sum(p);
    for (const KernelVariant* kernel : kKernels) {
      if (!kernel->supported()) continue;
      EXPECT_EQ(ListedFlock<float>(flock, Reach(p), kernel->name).Sum(p), scalar) << kernel->name;
    }
  }
}

TEST(ListedSums, BoidsAreThoseOfTheGrid) {
  ExpectSumsOfTheGrid(PlainRules(0.4, 1.05));
  ExpectSumsOfTheGrid(PlainRules(0.4, 1.05, 0.3));
}
TEST(ListedSums, BlindBoidsAreThoseOfTheGrid) {
  ExpectSumsOfTheGrid(BlindRules(2.0));
  ExpectSumsOfTheGrid(BlindRules(2.0, 0.3, 0.2));
}
TEST(ListedSums, ZonesAreThoseOfTheGrid) {
  ExpectSumsOfTheGrid(ZoneParameters{0.3, 0.6, 1, 0.2, 3, 13, 0});
  ExpectSumsOfTheGrid(ZoneParameters{0.3, 0.6, 1, 0.2, 3, 13, 0.2});
}

// A flock slow enough that its engine keeps lists for some steps and makes them anew now and then.
template <typename Parameters>
Engine SlowEngine(const Parameters& p, int threads, const std::string& kernel) {
  World world;
  world.dt = 0.01;
  NamedFlock flock = RandomFlock("", 1500, {10, 10, 10}, 42);
  for (Vec3d& v : flock.velocity) v = 0.3 * Normalized(v) + Vec3d{5, 0, 0};
  return Engine(world, {AsSwarm(flock, p)}, {.threads = threads, .kernel = kernel});
}

template <typename Parameters>
void ExpectSameBytes(const Parameters& p) {
  const auto after = [&](int threads, const std::string& kernel, int saved) {
    Engine engine = SlowEngine(p, threads, kernel);
    for (int k = 0; k < 60; ++k) {
      if (k == saved) {
        const std::string bytes = engine.Save();
        engine = SlowEngine(p, threads, kernel);
        engine.Load(bytes);
      }
      engine.Step();
    }
    return engine.State();
  };
  const FlockState expected = after(1, "", -1);
  for (const FlockState& actual :
       {after(3, "", -1), after(2, "scalar", -1), after(1, "sse2", -1), after(1, "", 17)}) {
    EXPECT_EQ(actual.position, expected.position);
    EXPECT_EQ(actual.velocity, expected.velocity);
  }
}

TEST(ListedSums, SlowFlocksHaveTheSameBytesWhateverRunsThem) {
  ExpectSameBytes(PlainRules(0.5, 1.3));
  BSwarmParameters swarm;
  swarm.zones = {0.3, 0.6, 1.2, 0.2, 3, 13, 0};
  ExpectSameBytes(swarm);
}

}  // namespace
}  // namespace flocklift
