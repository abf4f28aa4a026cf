// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/text.h"

#include <gtest/gtest.h>

namespace flocklift {
namespace {

TEST(Trim, TakesSpacesAndTabsOffBothEnds) {
  EXPECT_EQ(Trim(" \t a b\t "), "a b");
  EXPECT_EQ(Trim(" \t "), "");
  EXPECT_EQ(Trim(""), "");
}

TEST(ParseReal, ReadsWhatPeopleWrite) {
  EXPECT_EQ(ParseReal("1.5"), 1.5);
  EXPECT_EQ(ParseReal("-2"), -2);
  EXPECT_EQ(ParseReal("+3e2"), 300);
  EXPECT_EQ(ParseReal(".5"), 0.5);
}

TEST(ParseReal, RefusesAllElse) {
  for (const char* text : {"", " 1", "1 ", "1x", "x", "nan", "inf", "-inf", "1e999", "+", "+-1",
                           "++1", "0x10", "1,5", "1.5.5"}) {
    EXPECT_EQ(ParseReal(text), std::nullopt) << text;
  }
}

TEST(ParseInteger, ReadsWholeNumbersHoweverTheyAreWritten) {
  EXPECT_EQ(ParseInteger("7"), 7);
  EXPECT_EQ(ParseInteger("+7"), 7);
  EXPECT_EQ(ParseInteger("-7"), -7);
  EXPECT_EQ(ParseInteger("7.0"), 7);
  EXPECT_EQ(ParseInteger("7.000000000000000000e+00"), 7);
  EXPECT_EQ(ParseInteger("9223372036854775807"), INT64_MAX);
}

TEST(ParseInteger, RefusesAllElse) {
  for (const char* text : {"", "7.5", "7x", "nan", "1e300", "9223372036854775808", "+-7"}) {
    EXPECT_EQ(ParseInteger(text), std::nullopt) << text;
  }
}

TEST(Quoted, KeepsForeignTextShortAndOnOneLine) {
  EXPECT_EQ(Quoted("abc"), "`abc`");
  EXPECT_EQ(Quoted("a\nb\xff\x01"), "`a?b??`");
  EXPECT_EQ(Quoted(std::string(100, 'x')), "`" + std::string(40, 'x') + "...`");
}

}  // namespace
}  // namespace flocklift
