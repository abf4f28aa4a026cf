// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/metrics/matching.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

double TotalWeight(const std::vector<WeightedPair>& pairs, const std::vector<int>& chosen) {
  std::set<int> rows, columns;
  double total = 0;
  for (const int k : chosen) {
    EXPECT_TRUE(rows.insert(pairs[k].row).second) << "row " << pairs[k].row << " twice";
    EXPECT_TRUE(columns.insert(pairs[k].column).second) << "column " << pairs[k].column << " twice";
    EXPECT_GT(pairs[k].weight, 0);
    total += pairs[k].weight;
  }
  return total;
}

// The best total over all ways to give rows `row` .. `rows` - 1 a free column or none.
double BruteForce(const std::vector<std::vector<double>>& weight, std::size_t row,
                  std::set<int>* used) {
  if (row == weight.size()) return 0;
  double best = BruteForce(weight, row + 1, used);
  for (int column = 0; column < static_cast<int>(weight[row].size()); ++column) {
    if (weight[row][column] <= 0 || !used->insert(column).second) continue;
    best = std::max(best, weight[row][column] + BruteForce(weight, row + 1, used));
    used->erase(column);
  }
  return best;
}

TEST(Matching, NothingToMatch) { EXPECT_TRUE(MaximumWeightMatching({}).empty()); }

TEST(Matching, PrefersTheTotalOverTheHeaviestPair) {
  // Greedy takes 5 and then nothing; 4 + 3 is better.
  const std::vector<WeightedPair> pairs = {{0, 0, 5}, {0, 1, 4}, {1, 0, 3}};
  EXPECT_EQ(MaximumWeightMatching(pairs), (std::vector<int>{1, 2}));
}

TEST(Matching, LeavesARowSingleWhenThatIsWorthMore) {
  const std::vector<WeightedPair> pairs = {{0, 0, 10}, {1, 0, 3}, {0, 1, 6}};
  EXPECT_EQ(MaximumWeightMatching(pairs), (std::vector<int>{0}));
}

TEST(Matching, NeverChoosesWorthlessPairs) {
  const std::vector<WeightedPair> pairs = {{0, 0, 0}, {1, 1, -2}};
  EXPECT_TRUE(MaximumWeightMatching(pairs).empty());
}

TEST(Matching, OfEqualEndsTheHeavierCounts) {
  const std::vector<WeightedPair> pairs = {{0, 0, 1}, {0, 0, 2}};
  EXPECT_EQ(MaximumWeightMatching(pairs), (std::vector<int>{1}));
}

TEST(Matching, RefusesNegativeIndices) {
  const std::vector<WeightedPair> pairs = {{0, -1, 1}};
  EXPECT_THROW(MaximumWeightMatching(pairs), std::invalid_argument);
}

TEST(Matching, AgreesWithBruteForce) {
  for (int trial = 0; trial < 500; ++trial) {
    Rng rng(1, trial);
    const int rows = 1 + static_cast<int>(rng.Below(7)),
              columns = 1 + static_cast<int>(rng.Below(7));
    const double density = rng.Uniform(0.2, 1);
    const bool integers = rng.Below(2) == 0;  // many ties
    std::vector<std::vector<double>> weight(rows, std::vector<double>(columns, 0));
    std::vector<WeightedPair> pairs;
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < columns; ++c) {
        if (rng.Uniform() > density) continue;
        weight[r][c] = integers ? static_cast<double>(rng.Below(4)) : rng.Uniform(-0.2, 1);
        pairs.push_back({r, c, weight[r][c]});
      }
    }
    std::set<int> used;
    EXPECT_NEAR(TotalWeight(pairs, MaximumWeightMatching(pairs)), BruteForce(weight, 0, &used),
                1e-12)
        << "trial " << trial;
  }
}

TEST(Matching, LongChainsFlipAsAWhole) {
  // Row k likes column k (weight 1) and column k + 1 (weight 0.9); the last row only its own, at
  // weight 0.95 from a row added last that can only take column 0: everybody must move on.
  constexpr int kRows = 2000;
  std::vector<WeightedPair> pairs;
  for (int k = 0; k < kRows; ++k) {
    pairs.push_back({k, k, 1});
    pairs.push_back({k, k + 1, 0.9999});
  }
  pairs.push_back({kRows, 0, 1});
  EXPECT_NEAR(TotalWeight(pairs, MaximumWeightMatching(pairs)), 1 + 0.9999 * kRows, 1e-9);
}

}  // namespace
}  // namespace flocklift
