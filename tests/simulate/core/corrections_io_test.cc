// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "simulate/core/io.h"
#include "tests/simulate/core/fault.h"

namespace flocklift {
namespace {

using Kind = Correction::Kind;

std::vector<Correction> Parse(const std::string& text) {
  std::istringstream stream(text);
  return ReadCorrections(stream, "FILE");
}

TEST(Corrections, EveryOperationIsRead) {
  const auto corrections = Parse(
      "# what I saw\nswap 1 2 30 # they crossed\r\n\n  split\t4 17\njoin 5 6\ndelete 7\n"
      "delete 8 10 20\npin 9 3 100.5 -2\nadd 4 1 2\n");
  ASSERT_EQ(corrections.size(), 7u);
  EXPECT_EQ(corrections[0].kind, Kind::kSwap);
  EXPECT_EQ(corrections[0].id, 1);
  EXPECT_EQ(corrections[0].other_id, 2);
  EXPECT_EQ(corrections[0].first_frame, 30);
  EXPECT_EQ(corrections[0].line, 2);
  EXPECT_EQ(corrections[1].kind, Kind::kSplit);
  EXPECT_EQ(corrections[1].id, 4);
  EXPECT_EQ(corrections[1].first_frame, 17);
  EXPECT_EQ(corrections[2].kind, Kind::kJoin);
  EXPECT_EQ(corrections[2].other_id, 6);
  EXPECT_EQ(corrections[3].kind, Kind::kDelete);
  EXPECT_EQ(corrections[3].id, 7);
  EXPECT_EQ(corrections[3].first_frame, 0);
  EXPECT_EQ(corrections[4].first_frame, 10);
  EXPECT_EQ(corrections[4].last_frame, 20);
  EXPECT_EQ(corrections[5].kind, Kind::kPin);
  EXPECT_EQ(corrections[5].id, 9);
  EXPECT_EQ(corrections[5].first_frame, 3);
  EXPECT_EQ(corrections[5].point, (Vec2d{100.5, -2}));
  EXPECT_EQ(corrections[6].kind, Kind::kAdd);
  EXPECT_EQ(corrections[6].first_frame, 4);
  EXPECT_EQ(corrections[6].point, (Vec2d{1, 2}));
  EXPECT_EQ(corrections[6].line, 9);
}

TEST(Corrections, NoneIsNoFault) {
  EXPECT_TRUE(Parse("").empty());
  EXPECT_TRUE(Parse("# nothing to mend\n").empty());
}

TEST(Corrections, FaultsAreTold) {
  const std::vector<Fault> faults{
      {"swop 1 2 3\n", 1, "there is no operation `swop`; did you mean `swap`?"},
      {"\nswap 1 2\n", 2, "swap has 2 arguments; write swap ID ID FRAME"},
      {"delete 1 2\n", 1, "delete has 2 arguments"},
      {"split 1 2 3\n", 1, "split has 3 arguments"},
      {"pin 1 2 3\n", 1, "pin has 3 arguments"},
      {"swap 1 1 3\n", 1, "id 1 stands twice"},
      {"join 0 1\n", 1, "id 0 is not positive"},
      {"join 1 -1\n", 1, "id -1"},
      {"split 1 0\n", 1, "frame 0 is below 1"},
      {"split 1 1.5\n", 1, "`1.5` is not a whole number"},
      {"delete 1 20 10\n", 1, "frame 10 is before frame 20"},
      {"pin 1 2 nan 3\n", 1, "`nan` is not a finite number"},
      {"add 1 2 1e30\n", 1, "Y is 1e+30"},
      {"add one 2 3\n", 1, "`one` is not a whole number"},
  };
  for (const Fault& fault : faults) ExpectFault(fault, Parse);
}

}  // namespace
}  // namespace flocklift
