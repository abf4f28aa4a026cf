// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/plot/plot_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/plot/markup.h"
#include "tools/plot/svg_parts.h"

namespace flocklift {
namespace {

constexpr double kTitleHeight = 20, kHeaderHeight = 26;

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void Include(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool IsEmpty() const { return low > high; }
};

}  // namespace

PlotFrame MakeFrame(const PlotOptions& options, std::span<const PlotShape> shapes) {
  Extent x, y;
  bool has_bars = false;
  for (const PlotShape& shape : shapes) {
    if (!shape.style.sets_range) continue;
    if (shape.kind == PlotShape::Kind::kVertical) {
      x.Include(shape.points[0].x);
      continue;
    }
    if (shape.kind == PlotShape::Kind::kHorizontal) {
      y.Include(shape.points[0].y);
      continue;
    }
    if (shape.kind == PlotShape::Kind::kArrow || shape.kind == PlotShape::Kind::kText) {
      x.Include(shape.points[0].x);
      y.Include(shape.points[0].y);
      continue;
    }
    for (const auto* points : {&shape.points, &shape.upper}) {
      for (const Vec2d& p : *points) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y)) continue;
        x.Include(p.x);
        y.Include(p.y);
        if (shape.kind == PlotShape::Kind::kBars) x.Include(p.x + shape.bar_width);
      }
    }
    has_bars = has_bars || shape.kind == PlotShape::Kind::kBars;
  }
  if (x.IsEmpty()) x = {0, 1};
  if (y.IsEmpty()) y = {0, 1};
  if (has_bars) y.Include(0);

  PlotFrame frame;
  frame.top = (options.title.empty() ? 4 : kTitleHeight) + kHeaderHeight;
  const double bottom = options.x_label.empty() ? 22 : 40;
  frame.picture_height = options.height;
  if (options.equal_axes) {
    const double pad_x = std::max(0.04 * (x.high - x.low), 0.5);
    const double pad_y = std::max(0.04 * (y.high - y.low), 0.5);
    frame.x = {x.low - pad_x, x.high + pad_x};
    frame.y = {y.low - pad_y, y.high + pad_y};
  } else {
    const int rows = std::max(4, static_cast<int>(options.height / 48));
    frame.y = NiceRange(options.y_low.value_or(y.low), options.y_high.value_or(y.high), rows);
    if (options.y_low) frame.y.low = *options.y_low;
    if (options.y_high) frame.y.high = *options.y_high;
    frame.x = {options.x_low.value_or(x.low), options.x_high.value_or(x.high)};
    if (options.nice_x || !(frame.x.low < frame.x.high)) {
      frame.x = NiceRange(frame.x.low, frame.x.high, 8);
    }
    if (!(frame.y.low < frame.y.high)) frame.y = NiceRange(frame.y.low, frame.y.high, rows);
  }
  // Room for the y axis's numbers, whose width depends on the range.
  double widest = 0;
  for (const std::string& label : NiceTicks(frame.y.low, frame.y.high, 6).labels) {
    widest = std::max(widest, TextWidth(label));
  }
  frame.left = widest + 12;
  frame.width = options.width - frame.left - 14;
  if (options.equal_axes) {
    const double span_x = frame.x.high - frame.x.low, span_y = frame.y.high - frame.y.low;
    if (options.height <= 0) {
      const double needed = frame.width * span_y / span_x;
      frame.picture_height = std::clamp(needed, 150.0, 600.0) + frame.top + bottom;
    }
    frame.height = frame.picture_height - frame.top - bottom;
    const double metres_per_px = std::max(span_x / frame.width, span_y / frame.height);
    const double more_x = 0.5 * (metres_per_px * frame.width - span_x);
    const double more_y = 0.5 * (metres_per_px * frame.height - span_y);
    frame.x = {frame.x.low - more_x, frame.x.high + more_x};
    frame.y = {frame.y.low - more_y, frame.y.high + more_y};
  }
  frame.height = frame.picture_height - frame.top - bottom;
  return frame;
}

double HeaderLine(const PlotOptions& options) {
  return options.title.empty() ? 14 : kTitleHeight + 12;
}

void AppendAxes(const PlotOptions& options, const PlotFrame& frame, std::string* svg) {
  const double right = frame.left + frame.width, bottom = frame.top + frame.height;
  const int columns = std::max(4, static_cast<int>(frame.width / 80));
  const int rows = std::max(3, static_cast<int>(frame.height / 40));
  Ticks x = NiceTicks(frame.x.low, frame.x.high, columns);
  Ticks y = NiceTicks(frame.y.low, frame.y.high, rows);
  if (options.equal_axes && x.step != y.step) {  // one grid of squares, where it has enough rows
    const double step = std::max(x.step, y.step);
    const auto wanted = [&](const AxisRange& range) {
      return std::max(1, static_cast<int>(std::ceil((range.high - range.low) / step - 1e-9)));
    };
    if (wanted(frame.x) >= 3 && wanted(frame.y) >= 3) {
      x = NiceTicks(frame.x.low, frame.x.high, wanted(frame.x));
      y = NiceTicks(frame.y.low, frame.y.high, wanted(frame.y));
    }
  }
  std::string grid;
  for (const double at : y.at) {
    const double v = frame.top + frame.Local({0, at}).y;
    grid += fmt::format("M{} {}H{}", Coordinate(frame.left), Coordinate(v), Coordinate(right));
  }
  if (options.equal_axes) {
    for (const double at : x.at) {
      const double u = frame.left + frame.Local({at, 0}).x;
      grid += fmt::format("M{} {}V{}", Coordinate(u), Coordinate(frame.top), Coordinate(bottom));
    }
  }
  *svg += fmt::format("<path d=\"{}\" class=\"grid\"/>", grid);
  std::string marks =
      fmt::format("M{} {}H{}", Coordinate(frame.left), Coordinate(bottom), Coordinate(right));
  for (std::size_t k = 0; k < x.at.size(); ++k) {
    const double u = frame.left + frame.Local({x.at[k], 0}).x;
    marks += fmt::format("M{} {}v4", Coordinate(u), Coordinate(bottom));
    *svg += PixelText(u, bottom + 16, "middle", "tick", x.labels[k]);
  }
  for (std::size_t k = 0; k < y.at.size(); ++k) {
    const double v = frame.top + frame.Local({0, y.at[k]}).y;
    *svg += PixelText(frame.left - 6, v + 4, "end", "tick", y.labels[k]);
  }
  *svg += fmt::format("<path d=\"{}\" class=\"axis\"/>", marks);
  if (!options.title.empty()) *svg += PixelText(2, 14, "", "title", options.title);
  if (!options.y_label.empty())
    *svg += PixelText(2, HeaderLine(options), "", "label", options.y_label);
  if (!options.x_label.empty()) {
    *svg += PixelText(frame.left + 0.5 * frame.width, frame.picture_height - 5, "middle", "label",
                      options.x_label);
  }
}

}  // namespace flocklift
