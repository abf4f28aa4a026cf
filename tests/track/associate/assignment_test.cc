// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/assignment.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <stdexcept>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

double CostOf(const std::vector<int>& column_of, const std::vector<Candidate>& candidates,
              const std::vector<double>& alone) {
  double sum = 0;
  std::set<int> used;
  for (std::size_t row = 0; row < column_of.size(); ++row) {
    if (column_of[row] < 0) {
      sum += alone[row];
      continue;
    }
    EXPECT_TRUE(used.insert(column_of[row]).second) << "a column is taken twice";
    double best = 1e300;
    for (const Candidate& c : candidates) {
      if (c.row == static_cast<int>(row) && c.column == column_of[row])
        best = std::min(best, c.cost);
    }
    EXPECT_LT(best, 1e299) << "no such candidate";
    sum += best;
  }
  return sum;
}

// Tries everything.
double BruteForce(int columns, const std::vector<Candidate>& candidates,
                  const std::vector<double>& alone) {
  const int rows = static_cast<int>(alone.size());
  double best = 1e300;
  std::vector<char> used(columns, 0);
  const std::function<void(int, double)> go = [&](int row, double sum) {
    if (row == rows) {
      best = std::min(best, sum);
      return;
    }
    go(row + 1, sum + alone[row]);
    for (const Candidate& c : candidates) {
      if (c.row != row || used[c.column]) continue;
      used[c.column] = 1;
      go(row + 1, sum + c.cost);
      used[c.column] = 0;
    }
  };
  go(0, 0);
  return best;
}

TEST(AssignmentTest, AgreesWithBruteForce) {
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    Rng rng(seed);
    const int rows = 1 + static_cast<int>(rng.Below(6)),
              columns = 1 + static_cast<int>(rng.Below(6));
    std::vector<Candidate> candidates;
    std::vector<double> alone;
    for (int i = 0; i < rows; ++i) {
      alone.push_back(rng.Uniform(-2, 6));
      for (int j = 0; j < columns; ++j) {
        if (rng.Uniform() < 0.6) candidates.push_back({i, j, rng.Uniform(-5, 5)});
      }
    }
    if (!candidates.empty()) candidates.push_back(candidates.front());  // a duplicate is harmless
    const std::vector<int> column_of = Assign(columns, candidates, alone);
    ASSERT_EQ(column_of.size(), alone.size());
    EXPECT_NEAR(CostOf(column_of, candidates, alone), BruteForce(columns, candidates, alone), 1e-9)
        << "seed " << seed;
  }
}

// A ring of rows that would all prefer their neighbour's column: a long augmenting path.
TEST(AssignmentTest, LongChainsAreSolved) {
  constexpr int kCount = 2000;
  std::vector<Candidate> candidates;
  for (int k = 0; k < kCount; ++k) {
    candidates.push_back({k, k, 2.0});
    if (k > 0) candidates.push_back({k, k - 1, 1.0});
  }
  const std::vector<double> alone(kCount, 1e6);
  const std::vector<int> column_of = Assign(kCount, candidates, alone);
  EXPECT_EQ(column_of[0], 0);
  for (int k = 1; k < kCount; ++k) EXPECT_TRUE(column_of[k] == k || column_of[k] == k - 1);
  EXPECT_DOUBLE_EQ(CostOf(column_of, candidates, alone), 2.0 * kCount);
}

TEST(AssignmentTest, StaysAloneWhenThatIsCheaper) {
  const std::vector<Candidate> candidates{{0, 0, 3.0}, {1, 0, 1.0}};
  EXPECT_EQ(Assign(1, candidates, std::vector<double>{2, 2}), (std::vector<int>{-1, 0}));
  EXPECT_EQ(Assign(1, candidates, std::vector<double>{10, 2}), (std::vector<int>{0, -1}));
}

TEST(AssignmentTest, EmptyProblems) {
  EXPECT_TRUE(Assign(3, {}, {}).empty());
  EXPECT_EQ(Assign(0, {}, std::vector<double>{1, 1}), (std::vector<int>{-1, -1}));
}

TEST(AssignmentTest, RefusesIndicesOutOfRange) {
  const std::vector<double> alone{1};
  EXPECT_THROW(Assign(1, std::vector<Candidate>{{0, 1, 0}}, alone), std::invalid_argument);
  EXPECT_THROW(Assign(1, std::vector<Candidate>{{1, 0, 0}}, alone), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
