// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/plot/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "tools/plot/draw_shape.h"
#include "tools/plot/markup.h"
#include "tools/plot/plot_frame.h"
#include "tools/plot/svg_parts.h"

namespace flocklift {
namespace {

// On the line of the y label, right-aligned.
void AppendLegend(const PlotOptions& options, std::span<const PlotShape> shapes,
                  const PlotFrame& frame, std::string* svg) {
  std::vector<const PlotShape*> entries;
  double needed = 0;
  for (const PlotShape& shape : shapes) {
    if (shape.style.label.empty()) continue;
    entries.push_back(&shape);
    needed += 24 + TextWidth(shape.style.label) + 14;
  }
  const double v = HeaderLine(options) - 4;
  double u = std::max(TextWidth(options.y_label) + 24, frame.left + frame.width - needed + 14);
  for (const PlotShape* shape : entries) {
    AppendSample(*shape, u, v, svg);
    *svg += PixelText(u + 24, v + 4, "", "label", shape->style.label);
    u += 24 + TextWidth(shape->style.label) + 14;
  }
}

}  // namespace

std::string SeriesColor(std::size_t k) { return fmt::format("var(--c{})", k % 8); }

void Plot::AddLine(std::vector<Vec2d> points, PlotStyle style) {
  shapes_.push_back(
      {.kind = PlotShape::Kind::kLine, .style = std::move(style), .points = std::move(points)});
}

void Plot::AddBand(std::vector<BandPoint> points, PlotStyle style) {
  PlotShape shape{.kind = PlotShape::Kind::kBand, .style = std::move(style)};
  for (const BandPoint& p : points) {
    // Both edges break together.
    const double broken = p.low + p.high;
    shape.points.push_back({p.x, std::isfinite(broken) ? p.low : broken});
    shape.upper.push_back({p.x, std::isfinite(broken) ? p.high : broken});
  }
  shapes_.push_back(std::move(shape));
}

void Plot::AddPoints(std::vector<Vec2d> points, PlotStyle style) {
  shapes_.push_back(
      {.kind = PlotShape::Kind::kPoints, .style = std::move(style), .points = std::move(points)});
}

void Plot::AddBars(const Histogram& histogram, PlotStyle style) {
  PlotShape shape{.kind = PlotShape::Kind::kBars, .style = std::move(style)};
  shape.bar_width = (histogram.high - histogram.low) / static_cast<double>(histogram.share.size());
  for (std::size_t k = 0; k < histogram.share.size(); ++k) {
    shape.points.push_back(
        {histogram.low + static_cast<double>(k) * shape.bar_width, histogram.share[k]});
  }
  shapes_.push_back(std::move(shape));
}

void Plot::AddOutline(const Histogram& histogram, PlotStyle style) {
  const double bin = (histogram.high - histogram.low) / static_cast<double>(histogram.share.size());
  std::vector<Vec2d> points = {{histogram.low, 0}};
  for (std::size_t k = 0; k < histogram.share.size(); ++k) {
    const double left = histogram.low + static_cast<double>(k) * bin;
    points.push_back({left, histogram.share[k]});
    points.push_back({left + bin, histogram.share[k]});
  }
  points.push_back({histogram.high, 0});
  AddLine(std::move(points), std::move(style));
}

void Plot::AddArrow(const Vec2d& at, const Vec2d& direction, PlotStyle style) {
  shapes_.push_back(
      {.kind = PlotShape::Kind::kArrow, .style = std::move(style), .points = {at, direction}});
}

void Plot::AddText(const Vec2d& at, std::string text, PlotStyle style) {
  shapes_.push_back({.kind = PlotShape::Kind::kText,
                     .style = std::move(style),
                     .points = {at},
                     .text = std::move(text)});
}

void Plot::AddVerticalLine(double x, PlotStyle style) {
  shapes_.push_back(
      {.kind = PlotShape::Kind::kVertical, .style = std::move(style), .points = {{x, 0}}});
}

void Plot::AddHorizontalLine(double y, PlotStyle style) {
  shapes_.push_back(
      {.kind = PlotShape::Kind::kHorizontal, .style = std::move(style), .points = {{0, y}}});
}

std::string Plot::Svg() const {
  const PlotFrame frame = MakeFrame(options_, shapes_);
  std::string svg =
      fmt::format("<svg class=\"plot{}\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">",
                  options_.width > 700 ? " wide" : "", Coordinate(options_.width),
                  Coordinate(frame.picture_height), EscapeMarkup(options_.title));
  AppendAxes(options_, frame, &svg);
  svg += fmt::format("<svg x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\">", Coordinate(frame.left),
                     Coordinate(frame.top), Coordinate(frame.width), Coordinate(frame.height));
  for (const PlotShape& shape : shapes_) AppendShape(frame, shape, &svg);
  svg += "</svg>";
  AppendLegend(options_, shapes_, frame, &svg);
  return svg + "</svg>\n";
}

}  // namespace flocklift
