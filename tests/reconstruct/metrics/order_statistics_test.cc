// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/metrics/order_statistics.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace flocklift {
namespace {

TEST(OrderStatistics, QuantilesByHand) {
  EXPECT_DOUBLE_EQ(*Median({3, 1, 2}), 2);
  EXPECT_DOUBLE_EQ(*Median({4, 1, 3, 2}), 2.5);
  EXPECT_DOUBLE_EQ(*Quantile({4, 1, 3, 2}, 0.9), 3.7);  // numpy.percentile([1, 2, 3, 4], 90)
  EXPECT_DOUBLE_EQ(*Quantile({4, 1, 3, 2}, 0), 1);
  EXPECT_DOUBLE_EQ(*Quantile({4, 1, 3, 2}, 1), 4);
  EXPECT_FALSE(Median({}).has_value());
  EXPECT_THROW(QuantileOfSorted({}, 0.5), std::invalid_argument);
  EXPECT_THROW(Quantile({1}, 1.5), std::invalid_argument);
}

TEST(OrderStatistics, SpearmanByHand) {
  const std::vector<double> up = {1, 2, 3, 4, 5};
  EXPECT_DOUBLE_EQ(*SpearmanCorrelation(up, std::vector<double>{1, 4, 9, 16, 25}), 1);
  EXPECT_DOUBLE_EQ(*SpearmanCorrelation(up, std::vector<double>{5, 4, 3, 2, 1}), -1);
  // Without ties rho = 1 - 6 sum d^2 / (n (n^2 - 1)): d = (1, -1, 0, 0, 0).
  EXPECT_DOUBLE_EQ(*SpearmanCorrelation(up, std::vector<double>{2, 1, 3, 4, 5}), 0.9);
  // scipy.stats.spearmanr([1, 2, 2, 4], [1, 3, 2, 4]).correlation
  EXPECT_NEAR(
      *SpearmanCorrelation(std::vector<double>{1, 2, 2, 4}, std::vector<double>{1, 3, 2, 4}),
      0.9486832980505138, 1e-14);
}

TEST(OrderStatistics, SpearmanOfAConstantDoesNotExist) {
  const std::vector<double> up = {1, 2, 3}, flat = {7, 7, 7};
  EXPECT_FALSE(SpearmanCorrelation(up, flat).has_value());
  EXPECT_FALSE(SpearmanCorrelation({}, {}).has_value());
  EXPECT_THROW(SpearmanCorrelation(up, {}), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
