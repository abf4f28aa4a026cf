// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/correspondence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/shapes/hilbert.h"
#include "simulate/shapes/surface_samples.h"
#include "tests/simulate/shapes/solids.h"

namespace flocklift {
namespace {

std::vector<Vec3d> Cloud(int count, std::uint64_t seed, const Vec3d& center) {
  std::vector<Vec3d> points;
  Rng rng(seed);
  for (int k = 0; k < count; ++k) {
    points.push_back(center + Vec3d{rng.Uniform(), rng.Uniform(), rng.Uniform()});
  }
  return points;
}

std::vector<Vec3d> OnABall(int count) {
  const TriangleMesh ball = Ball(3);
  std::vector<Vec3d> points;
  for (const SurfaceSample& s : StratifiedSamples(ball, count, 1)) {
    points.push_back(SamplePoint(ball.vertices, ball.triangles, s));
  }
  return points;
}

bool IsBijection(std::vector<std::uint32_t> target_of) {
  std::sort(target_of.begin(), target_of.end());
  for (std::uint32_t k = 0; k < target_of.size(); ++k) {
    if (target_of[k] != k) return false;
  }
  return true;
}

// The cheapest assignment, by shortest augmenting paths with potentials (Kuhn-Munkres), n^3.
double OptimalCost(const std::vector<Vec3d>& agents, const std::vector<Vec3d>& targets) {
  const std::size_t n = agents.size();
  const auto cost = [&](std::size_t i, std::size_t j) {
    return SquaredNorm(agents[i - 1] - targets[j - 1]);
  };
  std::vector<double> u(n + 1), v(n + 1);
  std::vector<std::size_t> row_of(n + 1, 0), back(n + 1);
  for (std::size_t i = 1; i <= n; ++i) {
    row_of[0] = i;
    std::size_t at = 0;
    std::vector<double> least(n + 1, std::numeric_limits<double>::infinity());
    std::vector<bool> used(n + 1, false);
    while (row_of[at] != 0) {
      used[at] = true;
      std::size_t next = 0;
      double delta = std::numeric_limits<double>::infinity();
      for (std::size_t j = 1; j <= n; ++j) {
        if (used[j]) continue;
        const double reduced = cost(row_of[at], j) - u[row_of[at]] - v[j];
        if (reduced < least[j]) {
          least[j] = reduced;
          back[j] = at;
        }
        if (least[j] < delta) {
          delta = least[j];
          next = j;
        }
      }
      for (std::size_t j = 0; j <= n; ++j) {
        if (used[j]) {
          u[row_of[j]] += delta;
          v[j] -= delta;
        } else {
          least[j] -= delta;
        }
      }
      at = next;
    }
    for (; at != 0; at = back[at]) row_of[at] = row_of[back[at]];
  }
  return -v[0];
}

TEST(MatchTargets, OptimalCostIsTheBestOfAllPermutations) {  // the oracle itself
  const auto agents = Cloud(6, 1, {}), targets = Cloud(6, 2, {1, 0, 0});
  std::vector<std::uint32_t> order(6);
  std::iota(order.begin(), order.end(), 0U);
  double best = 1e300;
  do {
    best = std::min(best, MatchCost(agents, targets, order));
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_NEAR(OptimalCost(agents, targets), best, 1e-12);
}

TEST(MatchTargets, IsNearTheOptimum) {
  struct Case {
    std::vector<Vec3d> agents, targets;
  };
  for (const Case& c : {Case{Cloud(300, 1, {}), Cloud(300, 2, {})},
                        Case{Cloud(300, 3, {-0.5, -0.5, -0.5}), OnABall(300)}}) {
    const auto matched = MatchTargets(c.agents, c.targets, {});
    const auto curve = MatchTargets(c.agents, c.targets, {.max_rounds = 0});
    EXPECT_TRUE(IsBijection(matched));
    EXPECT_TRUE(IsBijection(curve));
    const double optimum = OptimalCost(c.agents, c.targets);
    EXPECT_GE(MatchCost(c.agents, c.targets, matched), optimum * (1 - 1e-12));
    EXPECT_LT(MatchCost(c.agents, c.targets, matched), 1.25 * optimum);
    EXPECT_LT(MatchCost(c.agents, c.targets, matched), MatchCost(c.agents, c.targets, curve));
  }
}

TEST(MatchTargets, FindsAShiftedCopy) {
  const auto agents = Cloud(500, 7, {});
  std::vector<Vec3d> targets;
  for (std::size_t k = 0; k < agents.size(); ++k) {  // in another order, far away
    targets.push_back(agents[(k * 7 + 3) % 500] + Vec3d{100, 0, -50});
  }
  const auto matched = MatchTargets(agents, targets, {});
  for (std::size_t k = 0; k < 500; ++k) EXPECT_EQ((matched[k] * 7 + 3) % 500, k);
}

TEST(MatchTargets, SmallAndDegenerateSets) {
  EXPECT_TRUE(MatchTargets({}, {}, {}).empty());
  EXPECT_EQ(MatchTargets({{1, 2, 3}}, {{4, 5, 6}}, {}), (std::vector<std::uint32_t>{0}));
  EXPECT_TRUE(IsBijection(MatchTargets(std::vector<Vec3d>(50), Cloud(50, 1, {}), {})));
  EXPECT_THROW(MatchTargets({{1, 2, 3}}, {}, {}), std::invalid_argument);
}

TEST(Hilbert, NeighboursOnTheCurveAreNeighboursInSpace) {
  // The first cells of the curve, in the corner of 8 x 8 x 8 that it fills first.
  std::vector<std::pair<std::uint64_t, Vec3d>> cells;
  for (std::uint32_t x = 0; x < 8; ++x) {
    for (std::uint32_t y = 0; y < 8; ++y) {
      for (std::uint32_t z = 0; z < 8; ++z) {
        cells.push_back({internal::HilbertIndex(x, y, z), {1.0 * x, 1.0 * y, 1.0 * z}});
      }
    }
  }
  std::sort(cells.begin(), cells.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t k = 0; k < cells.size(); ++k) {
    EXPECT_EQ(cells[k].first, k);
    if (k > 0) {
      EXPECT_EQ(SquaredNorm(cells[k].second - cells[k - 1].second), 1);
    }
  }
}

}  // namespace
}  // namespace flocklift
