// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/fps.h"

#include <gtest/gtest.h>

namespace flocklift {
namespace {

TEST(ParseFps, ReadsDecimalsAndRatios) {
  EXPECT_EQ(ParseFps("25"), 25.0);
  EXPECT_EQ(ParseFps("29.97"), 29.97);
  EXPECT_EQ(ParseFps("30000/1001"), 30000.0 / 1001);
  EXPECT_EQ(ParseFps("1 / 2"), 0.5);
}

TEST(ParseFps, RefusesAllElse) {
  for (const char* text : {"", "0", "-25", "nan", "inf", "25fps", "30/", "/30", "30/0",
                           "-30/-1001x", "1/2/3", "1e7", "0/5"}) {
    EXPECT_EQ(ParseFps(text), std::nullopt) << text;
  }
}

TEST(FormatFps, IsReadBackAsTheSameNumber) {
  for (const double fps :
       {25.0, 30000.0 / 1001, 60000.0 / 1001, 24000.0 / 1001, 29.97, 1.0 / 3, 170.0, 0.001, 1e6}) {
    EXPECT_EQ(ParseFps(FormatFps(fps)), fps) << FormatFps(fps);
  }
  EXPECT_EQ(FormatFps(30000.0 / 1001), "30000/1001");
  EXPECT_EQ(FormatFps(25), "25");
}

}  // namespace
}  // namespace flocklift
