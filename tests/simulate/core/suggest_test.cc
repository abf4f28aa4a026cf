// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/suggest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace flocklift {
namespace {

// The definition, by recursion.
int SlowDistance(std::string_view a, std::string_view b) {
  if (a.empty() || b.empty()) return static_cast<int>(std::max(a.size(), b.size()));
  const std::string_view a1 = a.substr(1), b1 = b.substr(1);
  int distance = SlowDistance(a1, b1) + (a[0] == b[0] ? 0 : 1);
  distance = std::min({distance, SlowDistance(a1, b) + 1, SlowDistance(a, b1) + 1});
  if (a.size() > 1 && b.size() > 1 && a[0] == b[1] && a[1] == b[0]) {
    distance = std::min(distance, SlowDistance(a.substr(2), b.substr(2)) + 1);
  }
  return distance;
}

TEST(EditDistance, IsThatOfTheDefinition) {
  const std::vector<std::string> words{"", "a", "ab", "ba", "abc", "acb", "speed", "sped", "psede"};
  for (const std::string& a : words) {
    for (const std::string& b : words) {
      EXPECT_EQ(EditDistance(a, b), SlowDistance(a, b)) << a << " " << b;
    }
  }
}

TEST(SuggestName, NamesTheNearestOrAll) {
  const std::vector<std::string> known{"speed", "count", "wingspan"};
  EXPECT_EQ(SuggestName("sped", known), "did you mean `speed`?");
  EXPECT_EQ(SuggestName("WingSpan", known), "did you mean `wingspan`?");
  EXPECT_EQ(SuggestName("coutn", known), "did you mean `count`?");
  EXPECT_EQ(SuggestName("temperature", known), "known are speed, count, wingspan");
  EXPECT_EQ(SuggestName("x", {}), "there are none");
}

// Known names may come from a file, too.
TEST(SuggestName, StaysOnOneLine) {
  const std::vector<std::string> known{"a\nb\fc", std::string(99, 'x')};
  EXPECT_EQ(SuggestName("a\nb\f", known), "did you mean `a?b?c`?");
  EXPECT_EQ(SuggestName("speed", known), "known are a?b?c, " + std::string(40, 'x') + "...");
  const std::string list = SuggestName("speed", std::vector<std::string>(1000, "temperature"));
  EXPECT_LT(list.size(), 600u);
  EXPECT_TRUE(list.ends_with("temperature, ..."));
}

}  // namespace
}  // namespace flocklift
