// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/cell_grid.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "tests/simulate/flock/flocks.h"

namespace flocklift {
namespace {

// Which animals the nine runs offer to each animal.
template <typename T>
std::vector<std::set<std::uint32_t>> Offered(const CellGrid<T>& grid, const Bodies<T>& sorted) {
  const auto g = grid.view();
  std::vector<std::set<std::uint32_t>> offered(sorted.size());
  std::size_t seen = 0;
  for (int c = 1; c <= g.nz; ++c) {
    for (int b = 1; b <= g.ny; ++b) {
      for (std::uint32_t k = g.start[g.Cell(1, b, c)]; k < g.start[g.Cell(g.nx, b, c) + 1]; ++k) {
        ++seen;
        const int a = g.CellX(sorted.x[k]);
        EXPECT_GE(k, g.start[g.Cell(a, b, c)]);
        EXPECT_LT(k, g.start[g.Cell(a, b, c) + 1]);
        CellGrid<T>::ForEachRun(g, a, a, b, c, [&](std::uint32_t first, std::uint32_t last) {
          for (std::uint32_t j = first; j < last; ++j) {
            EXPECT_TRUE(offered[sorted.agent[k]].insert(sorted.agent[j]).second) << "twice";
          }
        });
      }
    }
  }
  EXPECT_EQ(seen, sorted.size());
  return offered;
}

template <typename T>
void ExpectNobodyMissed(const NamedFlock& flock, double reach) {
  const Bodies<T> bodies = AsBodies<T>(flock);
  CellGrid<T> grid;
  Bodies<T> sorted;
  grid.Sort(bodies, reach, &sorted);
  ASSERT_EQ(sorted.size(), bodies.size());
  const auto offered = Offered(grid, sorted);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::uint32_t j = 0; j < bodies.size(); ++j) {
      const T distance = Norm(bodies.Position(i) - bodies.Position(j));
      if (static_cast<double>(distance) <= reach) {
        EXPECT_TRUE(offered[i].contains(j)) << i << " " << j << " " << distance;
      }
    }
  }
}

TEST(CellGrid, NobodyWithinReachIsMissed) {
  for (const NamedFlock& flock : ManyFlocks()) {
    SCOPED_TRACE(flock.name);
    for (const double reach : {0.25, 1.0, 3.0, 1000.0}) {
      ExpectNobodyMissed<float>(flock, reach);
      ExpectNobodyMissed<double>(flock, reach);
    }
  }
}

TEST(CellGrid, OffersFewBeyondReach) {
  const Bodies<double> bodies = AsBodies<double>(RandomFlock("", 4000, {10, 10, 10}, 3));
  CellGrid<double> grid;
  Bodies<double> sorted;
  grid.Sort(bodies, 1, &sorted);
  std::size_t offers = 0;
  for (const auto& offered : Offered(grid, sorted)) offers += offered.size();
  EXPECT_LT(offers, 4000 * 27 * 4 * 1.3);  // 27 cells of 4 each
}

TEST(CellGrid, SortsStablyAndCarriesEverybodyAlong) {
  const Bodies<float> bodies = AsBodies<float>(RandomFlock("", 500, {4, 4, 4}, 5));
  CellGrid<float> grid;
  Bodies<float> sorted;
  grid.Sort(bodies, 1, &sorted);
  std::set<std::uint32_t> agents;
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    const std::uint32_t agent = sorted.agent[k];
    agents.insert(agent);
    EXPECT_EQ(sorted.Position(k), bodies.Position(agent));
    EXPECT_EQ(sorted.Velocity(k), bodies.Velocity(agent));
  }
  EXPECT_EQ(agents.size(), 500U);
  Bodies<float> again;
  grid.Sort(sorted, 1, &again);  // sorted already: nothing moves
  EXPECT_EQ(again.agent, sorted.agent);
}

TEST(CellGrid, EmptyFlock) {
  CellGrid<float> grid;
  Bodies<float> sorted;
  grid.Sort(AsBodies<float>({}), 1, &sorted);
  EXPECT_EQ(sorted.size(), 0U);
  EXPECT_EQ(grid.view().RowCount(), 0);
}

TEST(CellGrid, AnyNumberOfThreadsSortsTheSame) {
  std::vector<NamedFlock> flocks = ManyFlocks();
  flocks.push_back(RandomFlock("large", 70000, {40, 45, 40}, 31));
  flocks.push_back(RandomFlock("large and sparse", 20000, {400, 300, 500}, 32));
  for (const NamedFlock& flock : flocks) {
    SCOPED_TRACE(flock.name);
    CellGrid<float> grid, pooled;
    Bodies<float> expected, actual;
    grid.Sort(AsBodies<float>(flock), 1.05, &expected);
    for (const int threads : {1, 2, 5}) {
      ThreadPool pool(threads);
      pooled.Sort(AsBodies<float>(flock), 1.05, &actual, &pool);
      EXPECT_EQ(actual.agent, expected.agent);
      EXPECT_EQ(actual.vy, expected.vy);
      const auto a = pooled.view(), b = grid.view();
      ASSERT_EQ(a.Cell(a.nx, a.ny, a.nz), b.Cell(b.nx, b.ny, b.nz));
      for (int c = 0; c <= a.Cell(a.nx, a.ny, a.nz); ++c) EXPECT_EQ(a.start[c], b.start[c]);
    }
  }
}

TEST(CellGrid, RefusesPositionsThatAreNotFinite) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    NamedFlock flock = RandomFlock("", 10, {1, 1, 1}, 1);
    flock.position[7].y = bad;
    CellGrid<float> grid;
    Bodies<float> sorted;
    EXPECT_THROW(grid.Sort(AsBodies<float>(flock), 1, &sorted), std::runtime_error);
  }
}

}  // namespace
}  // namespace flocklift
