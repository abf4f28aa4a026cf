// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/near_patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "tests/simulate/flock/flocks.h"

namespace flocklift {
namespace {

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

// Two crowds: the first `split` animals, and the others, which have bodies as well.
template <typename T>
struct TwoCrowds {
  Bodies<T> bodies;
  std::vector<T> body;
  std::size_t split;
  T room;

  TwoCrowds(const NamedFlock& flock, std::size_t first, double room_of_each)
      : bodies(AsBodies<T>(flock)), split(first), room(static_cast<T>(room_of_each)) {
    Rng rng(first);
    for (std::size_t k = split; k < bodies.size(); ++k) {
      body.push_back(static_cast<T>(rng.Uniform(0, room_of_each)));
    }
  }
  std::vector<Crowd<T>> AsCrowds() {
    T *const x = bodies.x.data(), *const y = bodies.y.data(), *const z = bodies.z.data();
    return {{split, x, y, z, room},
            {bodies.size() - split, x + split, y + split, z + split, room, body.data()}};
  }
  T Room(std::size_t k) const { return k < split ? room : room + body[k - split]; }

  Pairs BruteForce() const {
    Pairs pairs;
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
      for (std::uint32_t j = i + 1; j < bodies.size(); ++j) {
        const T distance = Room(i) + Room(j);
        if (SquaredNorm(bodies.Position(j) - bodies.Position(i)) < distance * distance)
          pairs.insert({i, j});
      }
    }
    return pairs;
  }
};

template <typename T>
void Find(TwoCrowds<T>* flock, int threads, NearPatches<T>* patches) {
  ThreadPool pool(threads);
  const std::vector<Crowd<T>> crowds = flock->AsCrowds();
  patches->FindPairs(crowds, BoxesOf<T>(crowds, &pool), 4 * flock->room, &pool);
}

// By height, so that animals that follow each other are in one layer.
NamedFlock Layered(NamedFlock flock) {
  std::sort(flock.position.begin(), flock.position.end(),
            [](const Vec3d& a, const Vec3d& b) { return a.z < b.z; });
  return flock;
}

template <typename T>
void ExpectEveryPairOnce(const NamedFlock& flock, std::size_t split, double room, bool mixed) {
  SCOPED_TRACE(flock.name);
  TwoCrowds<T> two(flock, split, room);
  NearPatches<T> patches;
  Find(&two, 2, &patches);
  EXPECT_EQ(patches.pairs().size() == 1, mixed);
  Pairs found;
  for (const auto& some : patches.pairs()) {
    for (const ClosePair<T>& pair : some) {
      const std::uint32_t a = pair.first, b = pair.second;
      EXPECT_TRUE(found.insert({std::min(a, b), std::max(a, b)}).second) << "found twice";
      EXPECT_EQ(pair.way, two.bodies.Position(b) - two.bodies.Position(a));
      EXPECT_EQ(pair.distance, two.Room(a) + two.Room(b));
    }
  }
  const Pairs expected = two.BruteForce();
  EXPECT_GT(expected.size(), 20U);
  EXPECT_EQ(found, expected);
}

TEST(NearPatches, FindEveryPairOnce) {
  const NamedFlock layers = Layered(RandomFlock("layers", 7000, {20, 20, 60}, 1));
  for (const std::size_t split : {0, 2500, 7000}) {
    ExpectEveryPairOnce<double>(layers, split, 0.1, false);
    ExpectEveryPairOnce<float>(layers, split, 0.1, false);
  }
  ExpectEveryPairOnce<float>(RandomFlock("a few", 900, {9, 9, 9}, 3), 300, 0.1, true);
}

TEST(NearPatches, FindEveryPairOnceInAFlockWithoutOrder) {
  ExpectEveryPairOnce<float>(RandomFlock("mixed", 7000, {20, 20, 60}, 4), 2500, 0.1, true);
  // The patches of one species lie in those of the other.
  NamedFlock both = RandomFlock("two species", 7000, {20, 20, 60}, 2);
  const auto by_height = [](const Vec3d& p, const Vec3d& q) { return p.z < q.z; };
  std::sort(both.position.begin(), both.position.begin() + 3500, by_height);
  std::sort(both.position.begin() + 3500, both.position.end(), by_height);
  ExpectEveryPairOnce<float>(both, 3500, 0.1, true);
}

// The order counts: sums of several pushes are rounded by it.
TEST(NearPatches, TheSamePairsInTheSameOrderAtAnyNumberOfThreads) {
  for (const NamedFlock& flock : {Layered(RandomFlock("layers", 9000, {9, 9, 60}, 5)),
                                  RandomFlock("mixed", 9000, {9, 9, 60}, 6)}) {
    TwoCrowds<float> two(flock, 4000, 0.1);
    NearPatches<float> one, other;
    Find(&two, 1, &one);
    for (const int threads : {2, 3, 5}) {
      Find(&two, threads, &other);
      ASSERT_EQ(one.pairs().size(), other.pairs().size());
      for (std::size_t patch = 0; patch < one.pairs().size(); ++patch) {
        const auto same = [](const ClosePair<float>& a, const ClosePair<float>& b) {
          return a.first == b.first && a.second == b.second;
        };
        EXPECT_TRUE(std::equal(one.pairs()[patch].begin(), one.pairs()[patch].end(),
                               other.pairs()[patch].begin(), other.pairs()[patch].end(), same));
      }
    }
  }
}

TEST(NearPatches, WhatIsNoNumberIsNowhere) {
  NamedFlock flock = Layered(RandomFlock("", 5000, {20, 20, 60}, 7));
  flock.position[17].x = std::numeric_limits<double>::quiet_NaN();
  flock.position[2400].z = std::numeric_limits<double>::quiet_NaN();
  ExpectEveryPairOnce<float>(flock, 1000, 0.1, false);
}

}  // namespace
}  // namespace flocklift
