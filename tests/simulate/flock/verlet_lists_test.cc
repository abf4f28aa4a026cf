// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/verlet_lists.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/flock/pair_forces.h"
#include "tests/simulate/flock/flocks.h"

namespace flocklift {
namespace {

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;  // of agents

template <typename T>
Herd<T> HerdOf(const NamedFlock& flock) {
  Herd<T> herd;
  herd.now = AsBodies<T>(flock);
  return herd;
}

template <typename T>
Pairs Listed(const VerletLists<T>& lists, const Herd<T>& herd) {
  Pairs pairs;
  for (std::size_t k = 0; k < herd.size(); ++k) {
    const NearLists& chunk = lists.chunk(k / kListGrain);
    const std::size_t at = k % kListGrain;
    for (std::size_t n = chunk.begin[at / 8]; n < chunk.begin[at / 8 + 1]; ++n) {
      const std::uint32_t place = chunk.places[8 * n + at % 8];
      if (place == herd.size()) continue;  // nobody
      EXPECT_TRUE(pairs.emplace(herd.now.agent[k], herd.now.agent[place]).second);
    }
  }
  return pairs;
}

template <typename T>
Pairs BruteForce(const Bodies<T>& s, const NearReach<T>& reach) {
  Pairs pairs;
  for (std::size_t k = 0; k < s.size(); ++k) {
    for (std::size_t j = 0; j < s.size(); ++j) {
      if (j == k || !reach.Holds(s.Position(j) - s.Position(k))) continue;
      pairs.emplace(s.agent[k], s.agent[j]);
    }
  }
  return pairs;
}

TEST(NearLists, AreBruteForceWithEveryKernel) {
  ThreadPool pool(2);
  for (const NamedFlock& flock : ManyFlocks()) {
    for (const NearReach<float> reach : {NearReach<float>{1.0F, 0.5F}, {0.4F, 0.9F}, {3, 0}}) {
      const Pairs expected = BruteForce(AsBodies<float>(flock), reach);
      std::vector<const KernelVariant*> kernels{nullptr};
      for (const KernelVariant* kernel : kKernels) {
        if (kernel->supported()) kernels.push_back(kernel);
      }
      for (const KernelVariant* kernel : kernels) {
        SCOPED_TRACE(flock.name + (kernel != nullptr ? kernel->name : " scalar"));
        Herd<float> herd = HerdOf<float>(flock);
        VerletLists<float> lists(0);
        lists.Update(reach, kernel, &pool, &herd);
        EXPECT_EQ(Listed(lists, herd), expected);
      }
    }
  }
}

// Whatever the animals do, and the reach, nobody within reach is missing; and the order of the herd
// stays while the lists do.
TEST(VerletLists, HoldEverybodyWithinReachWhileAllMove) {
  const NamedFlock flock = RandomFlock("", 1200, {9, 9, 9}, 31);
  ThreadPool pool(2);
  Herd<double> herd = HerdOf<double>(flock);
  VerletLists<double> lists(0.3);
  Rng rng(32);
  int kept = 0;
  for (int step = 0; step < 40; ++step) {
    const double growth = step < 20 ? 1 + 0.002 * step : 1.0;
    const NearReach<double> reach{0.9 * growth, 1.1 * growth};
    const std::vector<std::uint32_t> before = herd.now.agent;
    lists.Update(reach, nullptr, &pool, &herd);
    kept += herd.now.agent == before ? 1 : 0;
    const Pairs listed = Listed(lists, herd);
    const Pairs near = BruteForce(herd.now, reach);
    for (const auto& pair : near) EXPECT_TRUE(listed.contains(pair));
    for (std::size_t k = 0; k < herd.size(); ++k) {
      const Vec3d drift{3, -1, 0.5};  // of all
      const Vec3d own{0.02 * rng.Normal(), 0.02 * rng.Normal(), 0.02 * rng.Normal()};
      herd.now.Set(k, herd.now.Position(k) + drift + own, {});
    }
  }
  EXPECT_GT(kept, 10);
  EXPECT_LT(kept, 35);
}

// The last animal goes a little less than half a skin towards the first, and then a little more.
TEST(VerletLists, AreMadeAgainWhenTwoMayHaveMet) {
  NamedFlock flock = RandomFlock("", 0, {}, 33);
  flock.position = {{0, 0, 0}, {1.2, 0, 0}, {5, 5, 5}};
  flock.velocity.resize(3);
  ThreadPool pool(1);
  Herd<double> herd = HerdOf<double>(flock);
  VerletLists<double> lists(0.1);  // of 1 m
  const NearReach<double> reach{1, 0};
  lists.Update(reach, nullptr, &pool, &herd);
  EXPECT_TRUE(Listed(lists, herd).empty());
  for (const double x : {1.11, 1.0}) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (herd.now.agent[k] == 1) herd.now.x[k] = x;
    }
    lists.Update(reach, nullptr, &pool, &herd);
    EXPECT_EQ(Listed(lists, herd).size(), x > 1.1 ? 0U : 2U);
  }
}

// The grid refuses them; kept lists must not hide them from it.
TEST(VerletLists, DoNotHoldForPlacesThatAreNoNumbers) {
  ThreadPool pool(1);
  for (const std::size_t animal : {0U, 5U}) {
    Herd<float> herd = HerdOf<float>(RandomFlock("", 40, {4, 4, 4}, 35));
    VerletLists<float> lists(0.3);
    lists.Update({0.9F, 1.1F}, nullptr, &pool, &herd);
    herd.now.y[animal] = std::nanf("");
    EXPECT_THROW(lists.Update({0.9F, 1.1F}, nullptr, &pool, &herd), std::runtime_error);
  }
}

// 60 neighbours; 8 steps at the farthest velocity from the middle of all use up the skin.
TEST(VerletLists, AreMadeWhereTheyAreWorthIt) {
  ThreadPool pool(1);
  const NearReach<float> reach{1, 0};
  const double skin = 0.16, dt = 0.1;
  const auto worth = [&](double speed, double edge) {
    NamedFlock flock = RandomFlock("", 1000, {edge, edge, edge}, 36);
    for (Vec3d& v : flock.velocity) v = {30, 0, 0};  // all together
    flock.velocity[7].y = speed;
    flock.velocity[8].y = -speed;
    Herd<float> herd = HerdOf<float>(flock);
    VerletLists<float> lists(skin);
    const bool made = lists.UpdateIfWorth(reach, dt, nullptr, &pool, &herd);
    if (made) {
      const Pairs listed = Listed(lists, herd);
      for (const auto& pair : BruteForce(herd.now, reach)) EXPECT_TRUE(listed.contains(pair));
    }
    return made;
  };
  EXPECT_TRUE(worth(0.09, 4));
  EXPECT_FALSE(worth(0.11, 4));
  EXPECT_FALSE(worth(0.09, 2));  // 500 neighbours
}

// What is left of older lists must not count once the herd has gone on without.
TEST(VerletLists, AreForgottenWhereTheyAreNotWorthIt) {
  ThreadPool pool(1);
  const NearReach<double> reach{1, 0};
  Herd<double> herd = HerdOf<double>(RandomFlock("", 600, {6, 6, 6}, 37));
  VerletLists<double> lists(0.2);
  EXPECT_TRUE(lists.UpdateIfWorth(reach, 1e-9, nullptr, &pool, &herd));
  herd.now.x[0] += 1;
  EXPECT_FALSE(lists.UpdateIfWorth(reach, 1e9, nullptr, &pool, &herd));
  herd.now.x[0] -= 1;
  EXPECT_FALSE(lists.UpdateIfWorth(reach, 1e9, nullptr, &pool, &herd));
}

TEST(VerletLists, AreTheSameAfterTheyWereSaved) {
  const NamedFlock flock = RandomFlock("", 700, {6, 6, 6}, 34);
  ThreadPool pool(1);
  Herd<float> herd = HerdOf<float>(flock);
  VerletLists<float> lists(0.3), loaded(0.3);
  const NearReach<float> reach{0.9F, 1.1F};
  lists.Update(reach, ChooseKernel(""), &pool, &herd);
  for (float& x : herd.now.x) x += 0.1F;  // all together
  herd.now.y[3] += 0.05F;
  StateWriter writer;
  lists.Save(&writer);
  StateReader reader(writer.bytes());
  loaded.Load(&reader);
  EXPECT_TRUE(reader.AtEnd());
  Herd<float> other = herd;
  const std::vector<std::uint32_t> order = herd.now.agent;
  lists.Update(reach, ChooseKernel(""), &pool, &herd);
  loaded.Update(reach, ChooseKernel(""), &pool, &other);
  EXPECT_EQ(herd.now.agent, order);  // kept
  for (std::size_t c = 0; c < 2; ++c) {
    EXPECT_EQ(lists.chunk(c).begin, loaded.chunk(c).begin);
    const std::size_t n = lists.chunk(c).begin.back();
    for (std::size_t k = 0; k < n; ++k) {
      EXPECT_EQ(lists.chunk(c).places[k], loaded.chunk(c).places[k]);
    }
  }
}

}  // namespace
}  // namespace flocklift
