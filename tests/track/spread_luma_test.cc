// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/spread_luma.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace flocklift::internal {
namespace {

int Spread(int luma) { return static_cast<int>(std::floor((luma - 16) * 255.0 / 219 + 0.5)); }

TEST(SpreadLuma, BlackGrayAndWhite) {
  const std::uint8_t from[] = {0, 16, 17, 126, 235, 255};
  std::uint8_t to[6] = {};
  SpreadLuma(from, 6, to);
  EXPECT_EQ(to[0], 0);
  EXPECT_EQ(to[1], 0);
  EXPECT_EQ(to[2], 1);
  EXPECT_EQ(to[3], 128);
  EXPECT_EQ(to[4], 255);
  EXPECT_EQ(to[5], 255);
}

TEST(SpreadLuma, EveryValueAtEveryPlaceOfARow) {
  // Rows of any length, so that what is left over by wide steps is spread too.
  for (int count = 1; count <= 300; ++count) {
    std::vector<std::uint8_t> from(count), to(count + 1, 77);
    for (int u = 0; u < count; ++u) from[u] = static_cast<std::uint8_t>(u * 7 + count);
    SpreadLuma(from.data(), count, to.data());
    for (int u = 0; u < count; ++u) {
      ASSERT_EQ(to[u], std::clamp(Spread(from[u]), 0, 255)) << int{from[u]} << " at " << u;
    }
    EXPECT_EQ(to[count], 77);  // the next row is not touched
  }
}

}  // namespace
}  // namespace flocklift::internal
