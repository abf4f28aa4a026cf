// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/line_reader.h"

#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "simulate/core/rng.h"
#include "tests/simulate/core/fault.h"

namespace flocklift {
namespace {

std::vector<std::string> Lines(const std::string& text) {
  std::istringstream stream(text);
  LineReader reader(stream, "FILE");
  std::vector<std::string> lines;
  std::string_view line;
  while (reader.Next(&line)) {
    lines.emplace_back(line);
    EXPECT_EQ(reader.line(), static_cast<long>(lines.size()));
  }
  EXPECT_FALSE(reader.Next(&line));
  return lines;
}

TEST(LineReader, SplitsAtLineEnds) {
  using Expected = std::vector<std::string>;
  EXPECT_EQ(Lines(""), Expected{});
  EXPECT_EQ(Lines("a"), Expected{"a"});
  EXPECT_EQ(Lines("a\nb"), (Expected{"a", "b"}));
  EXPECT_EQ(Lines("a\r\n\r\nb\r\n"), (Expected{"a", "", "b"}));
  EXPECT_EQ(Lines("\xEF\xBB\xBFname\n\xEF\xBB\xBF"), (Expected{"name", "\xEF\xBB\xBF"}));
}

// Lines of random lengths, so that they lie across the blocks in every way.
TEST(LineReader, JoinsBlocks) {
  std::vector<std::string> expected;
  std::string text;
  Rng rng(1);
  while (text.size() < 2'000'000) {
    expected.emplace_back(rng.Below(40'000), static_cast<char>('a' + rng.Below(26)));
    text += expected.back() + "\n";
  }
  EXPECT_EQ(Lines(text), expected);
}

TEST(LineReader, RefusesEndlessLines) {
  EXPECT_EQ(Lines(std::string(65'000, 'x')).size(), 1u);
  ExpectFault({"a\n" + std::string(70'000, 'x') + "\n", 2, "longer than"},
              [](const std::string& text) { Lines(text); });
}

}  // namespace
}  // namespace flocklift
