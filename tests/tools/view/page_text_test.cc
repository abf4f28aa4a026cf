// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/page_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <string>

namespace flocklift {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::size_t Count(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) {
    ++count;
  }
  return count;
}

TEST(PageText, HoldsAllThatItShows) {
  const PageText page({.script = "go()", .later = "more()", .style = "p {}", .missing = ""});
  const std::string html = page.With({{"session", "s"}}, "<meta name=\"x\">");
  EXPECT_THAT(html, HasSubstr("<style>p {}</style>"));
  EXPECT_THAT(html, HasSubstr("id=\"flocklift-data\">{\"session\":\"s\"}</script>"));
  EXPECT_THAT(html, HasSubstr("<script>go()</script>"));
  EXPECT_THAT(html, HasSubstr("id=\"flocklift-later\">more()</script>"));
  EXPECT_LT(html.find("<meta name=\"x\">"), html.find("</head>"));
  // The first script finds its data, and is not held up by the other.
  EXPECT_LT(html.find("flocklift-data"), html.find("go()"));
  EXPECT_LT(html.find("go()"), html.find("more()"));
}

// SHA-256 of "go()", "more()" and "p {}" in base 64, by openssl.
TEST(PageText, NamesWhatMayRun) {
  const PageText page({.script = "go()", .later = "more()", .style = "p {}", .missing = ""});
  EXPECT_EQ(page.policy(),
            "script-src 'sha256-5KYv+PUboo5h+0+YAtGRPbwv5d/QxzHslP4YGnUaxRw=' "
            "'sha256-tQCBHdhZF+YZA1SfmY9EcKxkOEB4SQok5ogPYW6m+QI='; style-src "
            "'sha256-SNJDlN1Iy2mnt7DOjQIyDb2LQE6O5PQiSZomcdzawQ4='");
}

TEST(PageText, NothingEndsItsElementFromWithin) {
  const PageText page({.script = "a = '</script>'",
                       .later = "b = '</script>'",
                       .style = "q::after { content: '</style>' }",
                       .missing = ""});
  const std::string html = page.With({{"name", "</script><script>evil()</script>"}});
  EXPECT_EQ(Count(html, "</script>"), 3U);
  EXPECT_EQ(Count(html, "</style>"), 1U);
  EXPECT_THAT(html, Not(HasSubstr("<script>evil()")));
}

}  // namespace
}  // namespace flocklift
