// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/report/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "simulate/core/rigid3.h"
#include "tools/report/view_basis.h"

namespace flocklift {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Page, EveryTextIsEscaped) {
  const std::string evil = "<script>alert('\"&')</script>";
  Page page(evil, evil);
  page.BeginSection("a\"b", evil);
  page.AddText(evil);
  page.AddNote(evil);
  page.AddCards({{evil, evil, evil}});
  page.AddFigure("<svg></svg>", evil);
  page.BeginGrid(2);
  page.AddTable({{evil}, {{evil}}}, evil);
  page.EndGrid();
  page.AddBars({{evil, evil, 1, 0}}, evil);
  page.BeginDetails(evil);
  page.EndDetails();
  const std::string html = page.Html();
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, Not(HasSubstr("alert('")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(&#39;&quot;&amp;&#39;)&lt;/script&gt;"));
  EXPECT_THAT(html, HasSubstr("id=\"a&quot;b\""));
}

TEST(Page, ForbidsScriptsAndFetchesNothing) {
  const std::string html = Page("t", "s").Html();
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  EXPECT_THAT(html, Not(HasSubstr("http://")));
  EXPECT_THAT(html, Not(HasSubstr("https://")));
  EXPECT_THAT(html, HasSubstr("prefers-color-scheme: dark"));
}

TEST(Page, LinksItsSections) {
  Page page("t", "s");
  page.BeginSection("one", "First");
  page.BeginSection("two", "Second");
  EXPECT_THAT(page.Html(), HasSubstr("<a href=\"#one\">First</a>\n<a href=\"#two\">Second</a>"));
}

TEST(Page, BarsAreSharesOfTheLongest) {
  Page page("t", "s");
  page.AddBars({{"a", "1 s", 1, 0}, {"b", "4 s", 4, 1}}, "");
  EXPECT_THAT(page.Html(), HasSubstr("width:25.00%"));
  EXPECT_THAT(page.Html(), HasSubstr("width:100.00%"));
}

void ExpectNear(const Vec3d& a, const Vec3d& b) { EXPECT_LT(Norm(a - b), 1e-12); }

TEST(ViewBasis, WithGravityUpIsUp) {
  Camera camera;
  camera.cam_from_world = LookAt({1, 2, 3}, {1, 12, 8});  // along +y, upwards
  const ViewBasis basis(camera, 1);
  EXPECT_TRUE(basis.knows_gravity());
  ExpectNear(basis.camera(), {0, 0, 3});
  ExpectNear(basis.FromWorld({5, 12, 7}), {4, 10, 7});
  ExpectNear(basis.Turned({0, 0, 2}), {0, 0, 2});
}

TEST(ViewBasis, WithoutAPoseTheImageSaysWhatIsUp) {
  const ViewBasis basis(Camera{}, 1);
  EXPECT_FALSE(basis.knows_gravity());
  ExpectNear(basis.FromWorld({1, 2, 3}), {1, 3, -2});  // x right, z ahead, y down
}

TEST(ViewBasis, ACameraThatLooksStraightUpStillHasAnAhead) {
  Camera camera;
  camera.cam_from_world = LookAt({0, 0, 0}, {0, 0, 10});
  const ViewBasis basis(camera, 1);
  const Vec3d ahead = basis.Turned({1, 0, 0}), side = basis.Turned({0, 1, 0});
  EXPECT_NEAR(std::hypot(ahead.x, ahead.y), 1, 1e-12);
  EXPECT_NEAR(Dot(ahead, side), 0, 1e-12);
}

}  // namespace
}  // namespace flocklift
