// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/error_shares.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace flocklift {
namespace {

TEST(ErrorShares, ByHand) {
  // Squared errors of two moments: 6 + 4 for the whole chain, 3 + 2 from the second stage on.
  const auto shares = SharesOf({{6, 4}, {3, 2}, {1, 1}});
  ASSERT_EQ(shares.size(), 3U);
  EXPECT_DOUBLE_EQ(shares[0].value, 0.5);
  EXPECT_DOUBLE_EQ(shares[1].value, 0.3);
  EXPECT_DOUBLE_EQ(shares[2].value, 0.2);
  EXPECT_NEAR(shares[0].sd, 0, 1e-15);  // one half at either moment
  // Without the first moment 1/4, without the second 2/6: half their distance.
  EXPECT_NEAR(shares[1].sd, 0.5 * (2.0 / 6 - 1.0 / 4), 1e-12);
}

TEST(ErrorShares, SumToOneAndMayBeNegative) {
  const auto shares = SharesOf({{2, 5, 1}, {4, 5, 2}, {1, 0, 3}, {0.5, 0.1, 0.2}});
  double sum = 0;
  for (const ErrorShare& share : shares) sum += share.value;
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_LT(shares[0].value, 0);  // the second stage alone is worse than both
}

TEST(ErrorShares, AMomentMoreOfTheSameChangesNoShare) {
  const auto few = SharesOf({{6, 4}, {3, 1}}), many = SharesOf({{6, 4, 6, 4}, {3, 1, 3, 1}});
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_DOUBLE_EQ(few[k].value, many[k].value);
    EXPECT_LT(many[k].sd, few[k].sd);
  }
}

TEST(ErrorShares, WithoutErrorNobodyHasAShare) {
  const auto shares = SharesOf({{0, 0}, {0, 0}});
  EXPECT_EQ(shares[0].value, 0);
  EXPECT_EQ(shares[1].sd, 0);
  EXPECT_THROW(SharesOf({}), std::invalid_argument);
  EXPECT_THROW(SharesOf({{1, 2}, {1}}), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
