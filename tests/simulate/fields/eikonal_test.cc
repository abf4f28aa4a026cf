// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/eikonal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

constexpr float kWall = Eikonal::kInfinite;

std::vector<float> Values(const Eikonal& eikonal, const Grid& grid) {
  std::vector<float> values(grid.size());
  for (std::size_t n = 0; n < grid.size(); ++n) values[n] = eikonal.At(n);
  return values;
}

TEST(Eikonal, ByHand) {
  const Grid grid{{0, 0, 0}, 2, 4, 3, 2};
  Eikonal eikonal(grid);
  EXPECT_TRUE(eikonal.IsWall(3));
  eikonal.SetSlowness(std::vector<float>(grid.size(), 0.5F));  // a cost of 1 per spacing
  eikonal.SetSeeds(std::vector<Eikonal::Seed>{{0, 0}});
  eikonal.Solve();
  for (int i = 0; i < 4; ++i) EXPECT_FLOAT_EQ(eikonal.At(grid.Index(i, 0, 0)), i);
  const double diagonal = 1 + std::sqrt(0.5);  // (u - 1)^2 + (u - 1)^2 = 1
  EXPECT_NEAR(eikonal.At(grid.Index(1, 1, 0)), diagonal, 1e-6);
  EXPECT_NEAR(eikonal.At(grid.Index(1, 0, 1)), diagonal, 1e-6);
  EXPECT_NEAR(eikonal.At(grid.Index(1, 1, 1)), diagonal + std::sqrt(1 / 3.0), 1e-6);
  EXPECT_EQ(eikonal.Neighbours(grid.Index(0, 0, 1))[4], 0);
  EXPECT_EQ(eikonal.Neighbours(grid.Index(0, 0, 1))[5], kWall);  // beyond the grid
}

TEST(Eikonal, AWallIsGoneRound) {
  const Grid grid{{0, 0, 0}, 1, 7, 5, 1};
  std::vector<float> slowness(grid.size(), 1.0F);
  for (int j = 0; j < 4; ++j) slowness[grid.Index(3, j, 0)] = kWall;  // a gap at j = 4
  Eikonal eikonal(grid);
  eikonal.SetSlowness(slowness);
  eikonal.SetSeeds(std::vector<Eikonal::Seed>{{grid.Index(2, 0, 0), 0}});
  eikonal.Solve();
  EXPECT_EQ(eikonal.At(grid.Index(3, 2, 0)), kWall);
  EXPECT_GT(eikonal.At(grid.Index(4, 0, 0)), 8);
  slowness[grid.Index(3, 4, 0)] = kWall;  // no way left
  eikonal.SetSlowness(slowness);
  eikonal.Solve();
  for (int j = 0; j < 5; ++j) {
    for (int i = 3; i < 7; ++i) EXPECT_EQ(eikonal.At(grid.Index(i, j, 0)), kWall);
  }
}

// A grid of random costs, walls and seeds, and random edits of it.
struct Problem {
  Grid grid{{0, 0, 0}, 0.5, 23, 17, 14};
  std::vector<float> slowness;
  std::vector<Eikonal::Seed> seeds;
  Rng rng;

  explicit Problem(std::uint64_t seed) : rng(seed) {
    for (std::size_t n = 0; n < grid.size(); ++n) slowness.push_back(Cost());
    for (int k = 0; k < 12; ++k) seeds.push_back(AnySeed());
  }
  float Cost() {
    return rng.Uniform() < 0.25 ? kWall : static_cast<float>(std::exp(0.7 * rng.Normal()));
  }
  Eikonal::Seed AnySeed() {
    return {rng.Below(static_cast<std::uint32_t>(grid.size())),
            rng.Uniform() < 0.5 ? 0 : static_cast<float>(rng.Uniform())};
  }
  void Edit() {
    if (rng.Uniform() < 0.6) seeds[rng.Below(12)] = AnySeed();
    for (std::uint32_t k = rng.Below(30); k > 0; --k) {
      slowness[rng.Below(static_cast<std::uint32_t>(grid.size()))] = Cost();
    }
  }
  Eikonal Fresh() const {
    Eikonal eikonal(grid);
    Give(&eikonal);
    return eikonal;
  }
  void Give(Eikonal* eikonal) const {
    eikonal->SetSlowness(slowness);
    eikonal->SetSeeds(seeds);
    eikonal->Solve();
  }
};

TEST(Eikonal, TheEquationsHoldAtEveryNode) {
  const Problem problem(1);
  const Grid& grid = problem.grid;
  const Eikonal eikonal = problem.Fresh();
  std::vector<double> seed(grid.size(), kWall);
  for (const auto& s : problem.seeds) seed[s.node] = std::min<double>(seed[s.node], s.value);
  int reached = 0, open = 0;
  for (std::size_t n = 0; n < grid.size(); ++n) {
    const double u = eikonal.At(n);
    if (eikonal.IsWall(n)) {
      EXPECT_EQ(u, kWall);
      continue;
    }
    const auto near = eikonal.Neighbours(n);
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double m = std::min(near[2 * axis], near[2 * axis + 1]);
      if (m < u && u != kWall) sum += (u - m) * (u - m);
    }
    const double step = problem.slowness[n] * grid.spacing;
    if (u == kWall) {
      for (const float other : near) EXPECT_EQ(other, kWall);  // cut off by walls
    } else if (u == seed[n]) {
      EXPECT_LE(sum, step * step * (1 + 1e-4));
    } else {
      EXPECT_NEAR(std::sqrt(sum) / step, 1, 1e-3) << n;
      ++open;
    }
    reached += u != kWall;
  }
  EXPECT_GT(open, 3000);
  EXPECT_GT(reached, 3500);
}

TEST(Eikonal, ALocalSolutionIsTheFreshOneToTheBit) {
  int local = 0;
  std::size_t most = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    Problem problem(seed);
    Eikonal kept = problem.Fresh();
    for (int edit = 0; edit < 12; ++edit) {
      const std::vector<float> before = Values(kept, problem.grid);
      problem.Edit();
      problem.Give(&kept);
      const std::vector<float> after = Values(kept, problem.grid);
      ASSERT_EQ(after, Values(problem.Fresh(), problem.grid)) << seed << " " << edit;
      if (kept.solved_all()) continue;
      ++local;
      const std::set<std::size_t> named(kept.changed().begin(), kept.changed().end());
      for (std::size_t n = 0; n < before.size(); ++n) {
        if (before[n] != after[n]) {
          EXPECT_TRUE(named.contains(n)) << n;
        }
      }
      most = std::max(most, named.size());
    }
  }
  EXPECT_GT(local, 20);
  EXPECT_GT(most, 100u);
}

TEST(Eikonal, NothingChangesWhenNothingIsEdited) {
  const Problem problem(4);
  Eikonal eikonal = problem.Fresh();
  problem.Give(&eikonal);
  EXPECT_FALSE(eikonal.solved_all());
  EXPECT_TRUE(eikonal.changed().empty());
}

TEST(Eikonal, RefusesNonsense) {
  Eikonal eikonal({{0, 0, 0}, 1, 2, 2, 2});
  EXPECT_THROW(eikonal.SetSlowness(std::vector<float>(7, 1.0F)), std::invalid_argument);
  EXPECT_THROW(eikonal.SetSlowness(std::vector<float>(8, 0.0F)), std::invalid_argument);
  EXPECT_THROW(eikonal.SetSeeds(std::vector<Eikonal::Seed>{{8, 0}}), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
