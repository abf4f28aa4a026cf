// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/close_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "simulate/flock/kernels/swarm_kernel.h"
#include "tests/simulate/flock/flocks.h"

namespace flocklift {
namespace {

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

// Two crowds: the first `split` animals, and the others.
template <typename T>
std::vector<Crowd<T>> TwoCrowds(Bodies<T>* bodies, std::size_t split, T room) {
  return {{split, bodies->x.data(), bodies->y.data(), bodies->z.data(), room, nullptr},
          {bodies->size() - split, bodies->x.data() + split, bodies->y.data() + split,
           bodies->z.data() + split, room, nullptr}};
}

template <typename T>
Pairs BruteForce(const Bodies<T>& bodies, T reach) {
  Pairs pairs;
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    for (std::uint32_t j = i + 1; j < bodies.size(); ++j) {
      if (SquaredNorm(bodies.Position(j) - bodies.Position(i)) < reach * reach)
        pairs.insert({i, j});
    }
  }
  return pairs;
}

template <typename T>
void ExpectEveryPairOnce(const NamedFlock& flock, T room) {
  SCOPED_TRACE(flock.name);
  Bodies<T> bodies = AsBodies<T>(flock);
  const std::vector<Crowd<T>> crowds = TwoCrowds(&bodies, bodies.size() / 3, room);
  ThreadPool pool(1);
  Company<T> company;
  company.Find(crowds, Around<T>(BoxesOf<T>(crowds, &pool)), 2 * room);
  CloseTable<T> table;
  table.Sort(company);
  table.FindPairs();
  Pairs found;
  for (const ClosePair<T>& pair : table.pairs()) {
    const std::uint32_t a = table.Animal(pair.first), b = table.Animal(pair.second);
    EXPECT_TRUE(found.insert({std::min(a, b), std::max(a, b)}).second) << "found twice";
    EXPECT_EQ(pair.way, bodies.Position(b) - bodies.Position(a));
    EXPECT_EQ(pair.distance, 2 * room);
  }
  EXPECT_EQ(found, BruteForce(bodies, 2 * room));
}

TEST(CloseTable, FindsEveryPairOnce) {
  NamedFlock far_apart = RandomFlock("two clusters", 1000, {2, 2, 2}, 6);
  for (std::size_t k = 0; k < 500; ++k) far_apart.position[k] += Vec3d{1e5, -1e5, 1e5};
  for (const NamedFlock& flock :
       {RandomFlock("sparse", 2000, {9, 8, 7}, 1), RandomFlock("thin", 3000, {30, 20, 9}, 8),
        RandomFlock("flat", 2000, {20, 0, 9}, 2), RandomFlock("a line", 2000, {0, 90, 0}, 3),
        RandomFlock("crush", 700, {1, 1, 1}, 4), RandomFlock("one place", 40, {0, 0, 0}, 5),
        far_apart}) {
    for (const double room : {0.02, 0.1, 0.3}) {
      ExpectEveryPairOnce<double>(flock, room);
      ExpectEveryPairOnce<float>(flock, static_cast<float>(room));
    }
  }
}

// Eight buckets, in the second as many as several packs hold.
TEST(CloseKernel, EveryVariantFindsTheSameAnimals) {
  const NamedFlock flock = RandomFlock("", 80, {1, 1, 1}, 7);
  Bodies<float> bodies = AsBodies<float>(flock);
  for (auto* column : {&bodies.x, &bodies.y, &bodies.z}) column->resize(96);
  const std::vector<float> room(96, 0.07F);
  const std::uint32_t runs[] = {3, 40, 0, 1, 9, 0, 7, 20};
  std::vector<std::uint32_t> start = {0}, bucket_of;
  for (std::uint32_t bucket = 0; bucket < 8; ++bucket) {
    start.push_back(start.back() + runs[bucket]);
    bucket_of.insert(bucket_of.end(), runs[bucket], bucket);
  }
  start.push_back(80);
  std::vector<std::uint32_t> lowest;
  for (std::uint32_t k = 0; k < 80; ++k) lowest.push_back(bucket_of[k] + 8 * k - k % 2);
  const CloseJob job{bodies.x.data(),
                     bodies.y.data(),
                     bodies.z.data(),
                     room.data(),
                     lowest.data(),
                     start.data(),
                     3,
                     5,
                     7};
  std::vector<std::uint32_t> expected;
  for (std::uint32_t k = 0; k < 80; ++k) {
    bool near = false;
    for (const std::uint32_t across : {0U, 3U, 5U, 8U}) {
      for (std::uint32_t j = k + 1; j < 80; ++j) {
        const std::uint32_t bucket = (lowest[k] + across) & 7U;
        if (bucket_of[j] != bucket && bucket_of[j] != ((bucket + 1) & 7U)) continue;
        near |= SquaredNorm(bodies.Position(j) - bodies.Position(k)) < 0.14F * 0.14F;
      }
    }
    if (near) expected.push_back(k);
  }
  ASSERT_GT(expected.size(), 5U);
  ASSERT_LT(expected.size(), 75U);
  for (const SwarmKernelVariant& variant : kSwarmKernels) {
    if (!variant.supported()) continue;
    std::vector<std::uint32_t> found(80);
    found.resize(variant.close(job, 0, 80, found.data()));
    EXPECT_EQ(found, expected) << variant.name;
  }
}

}  // namespace
}  // namespace flocklift
