// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/rng.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace flocklift {
namespace {

// Known-answer tests of the reference implementation (Random123 1.09, kat_vectors).
TEST(Philox, KnownAnswers) {
  EXPECT_EQ(Philox4x32({0, 0, 0, 0}, {0, 0}),
            (std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(Philox4x32({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (std::array<std::uint32_t, 4>{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
}

TEST(Rng, StreamsDependOnNothingButTheirKey) {
  Rng a(7, 3, 11);
  const double first = a.Normal();
  Rng other(7, 4, 11);
  other.Normal();
  Rng again(7, 3, 11);
  EXPECT_EQ(again.Normal(), first);
  EXPECT_NE(other.Normal(), first);
}

TEST(Rng, MomentsOfTheNormal) {
  Rng rng(42);
  constexpr int kDraws = 200000;
  double mean = 0, square = 0, fourth = 0;
  for (int k = 0; k < kDraws; ++k) {
    const double x = rng.Normal();
    mean += x;
    square += x * x;
    fourth += x * x * x * x;
  }
  EXPECT_NEAR(mean / kDraws, 0, 0.01);
  EXPECT_NEAR(square / kDraws, 1, 0.02);
  EXPECT_NEAR(fourth / kDraws, 3, 0.15);
}

TEST(Rng, BelowReachesBothEndsAndNoMore) {
  Rng rng(1);
  std::array<int, 5> hits{};
  for (int k = 0; k < 1000; ++k) ++hits.at(rng.Below(5));
  for (const int count : hits) EXPECT_GT(count, 120);
}

}  // namespace
}  // namespace flocklift
