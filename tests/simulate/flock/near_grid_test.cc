// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/near_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "simulate/flock/kernels/swarm_kernel.h"
#include "tests/simulate/flock/flocks.h"

namespace flocklift {
namespace {

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

template <typename T>
Crowd<T> AsCrowd(Bodies<T>* bodies, T room) {
  return {bodies->size(), bodies->x.data(), bodies->y.data(), bodies->z.data(), room, nullptr};
}

template <typename T>
Pairs Found(const NearGrid<T>& grid) {
  Pairs found;
  for (const auto& chunk : grid.pairs()) {
    for (const auto& pair : chunk) {
      const std::uint32_t a = grid.Animal(pair.first), b = grid.Animal(pair.second);
      EXPECT_TRUE(found.insert({std::min(a, b), std::max(a, b)}).second) << "found twice";
    }
  }
  return found;
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
  const Crowd<T> crowd = AsCrowd(&bodies, room);
  ThreadPool pool(2);
  NearGrid<T> grid;
  ASSERT_TRUE(grid.Sort({&crowd, 1}, Around<T>(BoxesOf<T>({&crowd, 1}, &pool)), 2 * room, &pool));
  grid.FindPairs(&pool);
  EXPECT_EQ(Found(grid), BruteForce(bodies, 2 * room));
}

TEST(NearGrid, FindsEveryPairOnce) {
  for (const NamedFlock& flock :
       {RandomFlock("sparse", 2000, {9, 8, 7}, 1),
        RandomFlock("few in much space", 3000, {30, 20, 9}, 8),
        RandomFlock("flat", 2000, {20, 0, 9}, 2), RandomFlock("a line", 2000, {0, 90, 0}, 3),
        RandomFlock("crush", 700, {1, 1, 1}, 4), RandomFlock("one place", 40, {0, 0, 0}, 5)}) {
    for (const double room : {0.05, 0.2, 0.3}) {
      ExpectEveryPairOnce<double>(flock, room);
      ExpectEveryPairOnce<float>(flock, static_cast<float>(room));
    }
  }
}

// Its cells would hold all of a cluster.
TEST(NearGrid, RefusesTheScattered) {
  NamedFlock flock = RandomFlock("two clusters", 2000, {2, 2, 2}, 6);
  for (std::size_t k = 0; k < 1000; ++k) flock.position[k] += Vec3d{1000, 1000, 1000};
  Bodies<float> bodies = AsBodies<float>(flock);
  const Crowd<float> crowd = AsCrowd(&bodies, 0.05F);
  ThreadPool pool(1);
  EXPECT_FALSE(NearGrid<float>{}.Sort(
      {&crowd, 1}, Around<float>(BoxesOf<float>({&crowd, 1}, &pool)), 0.1F, &pool));
  for (std::size_t k = 0; k < 1000; ++k) bodies.x[k] += 1e9F;  // no cell could tell places apart
  EXPECT_FALSE(NearGrid<float>{}.Sort(
      {&crowd, 1}, Around<float>(BoxesOf<float>({&crowd, 1}, &pool)), 0.1F, &pool));
}

// A row of five cells with 40, 1, 0, 30 and 9 animals; the rows that follow are empty, as are the
// cells around.
TEST(NearKernel, EveryVariantFindsTheSameAnimals) {
  const NamedFlock flock = RandomFlock("", 80, {1, 1, 1}, 7);
  Bodies<float> bodies = AsBodies<float>(flock);
  for (auto* column : {&bodies.x, &bodies.y, &bodies.z}) column->resize(96);
  const std::vector<float> room(96, 0.07F);
  const std::uint32_t runs[] = {40, 1, 0, 30, 9};
  std::vector<std::uint32_t> start = {0, 0}, cell;
  for (std::uint32_t c = 0; c < 5; ++c) {
    start.push_back(start.back() + runs[c]);
    cell.insert(cell.end(), runs[c], c + 1);
  }
  start.resize(20, 80);
  std::vector<std::uint32_t> marked = cell;
  for (std::size_t k = 0; k < 80; k += 3) marked[k] |= kNearAtRim;
  const NearJob job{bodies.x.data(), bodies.y.data(), bodies.z.data(), room.data(),
                    marked.data(),   start.data(),    {9, 10, 11, 12}};
  std::vector<std::uint32_t> expected;
  for (std::uint32_t k = 0; k < 80; ++k) {
    bool near = false;
    for (std::uint32_t j = k + 1; j < start[cell[k] + 2]; ++j) {
      near |= SquaredNorm(bodies.Position(j) - bodies.Position(k)) < 0.14F * 0.14F;
    }
    if (near) expected.push_back(k);
  }
  ASSERT_GT(expected.size(), 5U);
  ASSERT_LT(expected.size(), 75U);
  for (const SwarmKernelVariant& variant : kSwarmKernels) {
    if (!variant.supported()) continue;
    std::vector<std::uint32_t> found(80);
    found.resize(variant.near(job, 0, 80, found.data()));
    EXPECT_EQ(found, expected) << variant.name;
  }
}

}  // namespace
}  // namespace flocklift
