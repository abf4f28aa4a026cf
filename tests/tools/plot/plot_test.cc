// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/plot/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "simulate/core/rng.h"
#include "tools/plot/histogram.h"
#include "tools/plot/markup.h"
#include "tools/plot/simplify.h"
#include "tools/plot/ticks.h"

namespace flocklift {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Markup, Escapes) {
  EXPECT_EQ(EscapeMarkup("<b a=\"1\" c='2'>&amp;"),
            "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;amp;");
  EXPECT_EQ(EscapeMarkup("Möwe 30 \xE2\x80\x93 \xF0\x9F\x90\xA6"),
            "Möwe 30 \xE2\x80\x93 \xF0\x9F\x90\xA6");
  EXPECT_EQ(EscapeMarkup(std::string("a\0b\x1B", 4)),
            "a\xEF\xBF\xBD"
            "b\xEF\xBF\xBD");
  // A torn character, an overlong '<', a surrogate: none of them may pass.
  EXPECT_EQ(EscapeMarkup("\xC3"), "\xEF\xBF\xBD");
  EXPECT_EQ(EscapeMarkup("\xC0\xBC"), "\xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_EQ(EscapeMarkup("\xED\xA0\x80"), "\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD");
}

TEST(Markup, Numbers) {
  EXPECT_EQ(NumberText(12345.678), "12346");
  EXPECT_EQ(NumberText(0.012345), "0.0123");
  EXPECT_EQ(NumberText(-1.5, 2),
            "\xE2\x88\x92"
            "1.5");
  EXPECT_EQ(NumberText(0), "0");
  EXPECT_EQ(NumberText(1e12), "1e+12");
  EXPECT_EQ(NumberText(kNan), "n/a");
  EXPECT_EQ(FixedText(-0.001, 1), "0.0");  // no minus before a zero
  EXPECT_EQ(Coordinate(12.34), "12.3");
  EXPECT_EQ(Coordinate(12.04), "12");
  EXPECT_EQ(Coordinate(-0.01), "0");
}

TEST(Ticks, AreRound) {
  EXPECT_THAT(NiceTicks(0, 10, 5).labels, ElementsAre("0", "2", "4", "6", "8", "10"));
  EXPECT_THAT(NiceTicks(0.12, 0.31, 4).labels, ElementsAre("0.15", "0.20", "0.25", "0.30"));
  EXPECT_THAT(NiceTicks(-1, 1, 2).labels, ElementsAre("\xE2\x88\x92"
                                                      "1",
                                                      "0", "1"));
  EXPECT_THROW(NiceTicks(1, 1, 4), std::invalid_argument);
  EXPECT_THROW(NiceTicks(0, kNan, 4), std::invalid_argument);
}

TEST(Ticks, NeverMoreThanWantedAndInsideTheRange) {
  for (int trial = 0; trial < 300; ++trial) {
    Rng rng(1, trial);
    const double size = std::pow(10, rng.Uniform(-6, 6));
    const double low = size * rng.Uniform(-3, 3), high = low + size * rng.Uniform(0.1, 2);
    const int wanted = 1 + static_cast<int>(rng.Below(12));
    const Ticks ticks = NiceTicks(low, high, wanted);
    EXPECT_LE(ticks.at.size(), static_cast<std::size_t>(wanted + 1));
    for (const double at : ticks.at) {
      EXPECT_GE(at, low - 1e-6 * size);
      EXPECT_LE(at, high + 1e-6 * size);
    }
    const AxisRange range = NiceRange(low, high, wanted);
    EXPECT_LE(range.low, low + 1e-8 * size);
    EXPECT_GE(range.high, high - 1e-8 * size);
  }
}

TEST(Ticks, ARangeAroundOneValue) {
  const AxisRange range = NiceRange(5, 5, 4);
  EXPECT_LT(range.low, 5);
  EXPECT_GT(range.high, 5);
}

TEST(SimplifyLine, KeepsWhatCanBeSeen) {
  // A straight line needs two points, a corner three.
  std::vector<Vec2d> line;
  for (int k = 0; k <= 100; ++k) line.push_back({1.0 * k, k <= 50 ? 0.0 : k - 50.0});
  EXPECT_THAT(SimplifyLine(line, 0.1, 1000),
              ElementsAre(Vec2d{0, 0}, Vec2d{50, 0}, Vec2d{100, 50}));
}

TEST(SimplifyLine, BoundedAndNoSpikeIsLost) {
  std::vector<Vec2d> line;
  for (int k = 0; k < 200000; ++k) line.push_back({0.01 * k, Rng(1, k).Uniform()});
  line[123456].y = 50;
  line[77777].y = -40;
  const std::vector<Vec2d> few = SimplifyLine(line, 0.001, 500);
  EXPECT_LE(few.size(), 500u);
  const auto by_height = [](const Vec2d& a, const Vec2d& b) { return a.y < b.y; };
  EXPECT_EQ(std::max_element(few.begin(), few.end(), by_height)->y, 50);
  EXPECT_EQ(std::min_element(few.begin(), few.end(), by_height)->y, -40);
  EXPECT_EQ(few.front(), line.front());
  EXPECT_EQ(few.back(), line.back());
  EXPECT_TRUE(std::is_sorted(few.begin(), few.end(),
                             [](const Vec2d& a, const Vec2d& b) { return a.x < b.x; }));
}

TEST(ThinOut, SpreadsEvenly) {
  std::vector<Vec2d> points;
  for (int k = 0; k < 100; ++k) points.push_back({1.0 * k, 0});
  EXPECT_THAT(ThinOut(points, 4),
              ElementsAre(Vec2d{0, 0}, Vec2d{25, 0}, Vec2d{50, 0}, Vec2d{75, 0}));
  EXPECT_EQ(ThinOut(points, 1000).size(), 100u);
}

TEST(MakeHistogram, SharesOfAllValues) {
  const std::vector<double> values = {0, 0.5, 1, 1.9, 2, 7};
  const Histogram histogram = MakeHistogram(values, 0, 2, 2);
  EXPECT_NEAR(histogram.share[0], 100.0 * 2 / 6, 1e-12);
  EXPECT_NEAR(histogram.share[1], 100.0 * 3 / 6, 1e-12);  // 1, 1.9 and the upper end
  EXPECT_THROW(MakeHistogram(values, 1, 1, 2), std::invalid_argument);
}

TEST(Plot, TextIsEscaped) {
  Plot plot({.title = "<script>alert(1)</script>", .x_label = "a & b", .y_label = "\"y\""});
  plot.AddLine({{0, 0}, {1, 1}}, {.label = "<img src=x>"});
  plot.AddText({0, 0}, "</svg><b>", {});
  const std::string svg = plot.Svg();
  EXPECT_THAT(svg, Not(HasSubstr("<script")));
  EXPECT_THAT(svg, Not(HasSubstr("<img")));
  EXPECT_THAT(svg, Not(HasSubstr("<b>")));
  EXPECT_THAT(svg, HasSubstr("a &amp; b"));
}

TEST(Plot, LinesLandWhereTheAxesSay) {
  Plot plot({.width = 500, .height = 300, .y_low = 0, .y_high = 10});
  plot.AddLine({{0, 0}, {10, 10}}, {.color = "red"});
  // From the lower left to the upper right corner of the area inside the axes.
  const std::string svg = plot.Svg();
  const std::size_t inner = svg.find("<svg x=");
  ASSERT_NE(inner, std::string::npos);
  double x = 0, y = 0, width = 0, height = 0;
  ASSERT_EQ(
      std::sscanf(svg.c_str() + inner, "<svg x=\"%lf\" y=\"%lf\" width=\"%lf\" height=\"%lf\"", &x,
                  &y, &width, &height),
      4);
  double u = 0, v = 0, du = 0, dv = 0;
  const std::size_t path = svg.find("<path d=\"M", inner);
  ASSERT_EQ(std::sscanf(svg.c_str() + path, "<path d=\"M%lf %lfl%lf%lf", &u, &v, &du, &dv), 4);
  EXPECT_NEAR(u, 0, 0.1);
  EXPECT_NEAR(v, height, 0.1);
  EXPECT_NEAR(du, width, 0.1);
  EXPECT_NEAR(dv, -height, 0.1);
}

TEST(Plot, EqualAxesHaveSquareUnits) {
  Plot plot({.width = 600, .height = 0, .equal_axes = true});
  plot.AddLine({{0, 0}, {100, 0}, {100, 30}}, {.color = "red"});
  const std::string svg = plot.Svg();
  const std::size_t path = svg.find("<path d=\"M", svg.find("<svg x="));
  double u = 0, v = 0, du = 0, dv = 0, du2 = 0, dv2 = 0;
  ASSERT_EQ(std::sscanf(svg.c_str() + path, "<path d=\"M%lf %lfl%lf%lf%lf%lf", &u, &v, &du, &dv,
                        &du2, &dv2),
            6);
  EXPECT_NEAR(-dv2 / du, 0.3, 0.005);
}

TEST(Plot, ANanInterruptsTheLine) {
  Plot plot({});
  plot.AddLine({{0, 0}, {1, 1}, {2, kNan}, {3, 1}, {4, 0}}, {.color = "red"});
  const std::string svg = plot.Svg();
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  const std::size_t path = svg.find("<path d=\"M", svg.find("<svg x="));
  const std::string drawn = svg.substr(path, svg.find("/>", path) - path);
  EXPECT_EQ(std::count(drawn.begin(), drawn.end(), 'M'), 2);
}

TEST(Plot, EmptyPlotsAndOddNumbersAreDrawn) {
  EXPECT_THAT(Plot({}).Svg(), HasSubstr("</svg>"));
  Plot plot({.equal_axes = true});
  plot.AddPoints({{kNan, 1}, {1, 1}}, {.label = "points"});
  plot.AddArrow({1, 1}, {0, 0}, {});
  plot.AddArrow({1, 1}, {1, 0}, {});
  plot.AddBand({{0, 1, 2}, {1, kNan, 2}, {2, 1, 2}}, {});
  plot.AddBars(MakeHistogram({}, 0, 1, 3), {});
  plot.AddVerticalLine(0.5, {});
  plot.AddHorizontalLine(0.5, {});
  EXPECT_THAT(plot.Svg(), Not(HasSubstr("nan")));
}

TEST(Plot, LongSeriesStaySmall) {
  Plot plot({});
  std::vector<Vec2d> line, cloud;
  for (int k = 0; k < 300000; ++k) {
    line.push_back({1.0 * k, Rng(1, k).Normal()});
    cloud.push_back({Rng(2, k).Normal(), Rng(3, k).Normal()});
  }
  plot.AddLine(line, {});
  plot.AddPoints(cloud, {});
  EXPECT_LT(plot.Svg().size(), 150000u);
}

}  // namespace
}  // namespace flocklift
