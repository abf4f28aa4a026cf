// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/plot/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "tools/plot/markup.h"
#include "tools/plot/simplify.h"
#include "tools/plot/ticks.h"

namespace flocklift {
namespace {

constexpr double kTitleHeight = 20, kHeaderHeight = 26, kCharacter = 6.8;
constexpr std::size_t kMostLinePoints = 3000, kMostScatterPoints = 4000;
constexpr double kTolerancePx = 0.25;

bool IsFinite(const Vec2d& p) { return std::isfinite(p.x) && std::isfinite(p.y); }

// Characters, not bytes.
double TextWidth(std::string_view text) {
  const auto characters = std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  });
  return kCharacter * static_cast<double>(characters);
}

std::string Stroke(const PlotStyle& style) {
  std::string attributes = fmt::format(" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"",
                                       style.color, Coordinate(style.width));
  if (style.opacity < 1) attributes += fmt::format(" stroke-opacity=\"{:.2g}\"", style.opacity);
  if (!style.dash.empty()) attributes += fmt::format(" stroke-dasharray=\"{}\"", style.dash);
  return attributes;
}

std::string Fill(const PlotStyle& style) {
  std::string attributes = fmt::format(" fill=\"{}\"", style.color);
  if (style.opacity < 1) attributes += fmt::format(" fill-opacity=\"{:.2g}\"", style.opacity);
  return attributes;
}

// "M x y L x y ..", relative moves, tenths of a pixel.
std::string PathOf(const std::vector<Vec2d>& points) {
  std::string path;
  double x = 0, y = 0;
  for (const Vec2d& p : points) {
    // Steps between rounded positions, so that rounding never adds up.
    const double next_x = std::round(p.x * 10) / 10, next_y = std::round(p.y * 10) / 10;
    if (path.empty()) {
      path = fmt::format("M{} {}l", Coordinate(next_x), Coordinate(next_y));
    } else {
      const std::string dx = Coordinate(next_x - x), dy = Coordinate(next_y - y);
      if (dx == "0" && dy == "0") continue;
      if (path.back() != 'l' && dx.front() != '-') path += ' ';
      path += dx;
      if (dy.front() != '-') path += ' ';
      path += dy;
    }
    x = next_x;
    y = next_y;
  }
  if (!path.empty() && path.back() == 'l') path += "0 0";
  return path;
}

std::vector<std::vector<Vec2d>> FinitePieces(const std::vector<Vec2d>& points) {
  std::vector<std::vector<Vec2d>> pieces(1);
  for (const Vec2d& p : points) {
    if (IsFinite(p)) {
      pieces.back().push_back(p);
    } else if (!pieces.back().empty()) {
      pieces.emplace_back();
    }
  }
  if (pieces.back().empty()) pieces.pop_back();
  return pieces;
}

std::string PixelText(double x, double y, std::string_view anchor, std::string_view kind,
                      std::string_view text) {
  return fmt::format(
      "<text x=\"{}\" y=\"{}\" class=\"{}\"{}>{}</text>", Coordinate(x), Coordinate(y), kind,
      anchor.empty() ? "" : fmt::format(" text-anchor=\"{}\"", anchor), EscapeMarkup(text));
}

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

std::string SeriesColor(std::size_t k) { return fmt::format("var(--c{})", k % 8); }

struct Plot::Frame {
  double left = 0, top = 0, width = 0, height = 0;  // of the area inside the axes [px]
  double picture_height = 0;
  AxisRange x, y;

  // Data to pixels from the area's top-left corner.
  Vec2d Local(const Vec2d& p) const {
    return {(p.x - x.low) / (x.high - x.low) * width, (y.high - p.y) / (y.high - y.low) * height};
  }
  std::vector<Vec2d> Local(const std::vector<Vec2d>& points) const {
    std::vector<Vec2d> local;
    local.reserve(points.size());
    for (const Vec2d& p : points) local.push_back(Local(p));
    return local;
  }
};

void Plot::AddLine(std::vector<Vec2d> points, PlotStyle style) {
  shapes_.push_back({.kind = Kind::kLine, .style = std::move(style), .points = std::move(points)});
}

void Plot::AddBand(std::vector<BandPoint> points, PlotStyle style) {
  Shape shape{.kind = Kind::kBand, .style = std::move(style)};
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
      {.kind = Kind::kPoints, .style = std::move(style), .points = std::move(points)});
}

void Plot::AddBars(const Histogram& histogram, PlotStyle style) {
  Shape shape{.kind = Kind::kBars, .style = std::move(style)};
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
  shapes_.push_back({.kind = Kind::kArrow, .style = std::move(style), .points = {at, direction}});
}

void Plot::AddText(const Vec2d& at, std::string text, PlotStyle style) {
  shapes_.push_back(
      {.kind = Kind::kText, .style = std::move(style), .points = {at}, .text = std::move(text)});
}

void Plot::AddVerticalLine(double x, PlotStyle style) {
  shapes_.push_back({.kind = Kind::kVertical, .style = std::move(style), .points = {{x, 0}}});
}

void Plot::AddHorizontalLine(double y, PlotStyle style) {
  shapes_.push_back({.kind = Kind::kHorizontal, .style = std::move(style), .points = {{0, y}}});
}

Plot::Frame Plot::MakeFrame() const {
  Extent x, y;
  bool has_bars = false;
  for (const Shape& shape : shapes_) {
    if (!shape.style.sets_range) continue;
    if (shape.kind == Kind::kVertical) {
      x.Include(shape.points[0].x);
      continue;
    }
    if (shape.kind == Kind::kHorizontal) {
      y.Include(shape.points[0].y);
      continue;
    }
    if (shape.kind == Kind::kArrow || shape.kind == Kind::kText) {
      x.Include(shape.points[0].x);
      y.Include(shape.points[0].y);
      continue;
    }
    for (const auto* points : {&shape.points, &shape.upper}) {
      for (const Vec2d& p : *points) {
        if (!IsFinite(p)) continue;
        x.Include(p.x);
        y.Include(p.y);
        if (shape.kind == Kind::kBars) x.Include(p.x + shape.bar_width);
      }
    }
    has_bars = has_bars || shape.kind == Kind::kBars;
  }
  if (x.IsEmpty()) x = {0, 1};
  if (y.IsEmpty()) y = {0, 1};
  if (has_bars) y.Include(0);

  Frame frame;
  frame.top = (options_.title.empty() ? 4 : kTitleHeight) + kHeaderHeight;
  const double bottom = options_.x_label.empty() ? 22 : 40;
  frame.picture_height = options_.height;
  if (options_.equal_axes) {
    const double pad_x = std::max(0.04 * (x.high - x.low), 0.5);
    const double pad_y = std::max(0.04 * (y.high - y.low), 0.5);
    frame.x = {x.low - pad_x, x.high + pad_x};
    frame.y = {y.low - pad_y, y.high + pad_y};
  } else {
    const int rows = std::max(4, static_cast<int>(options_.height / 48));
    frame.y = NiceRange(options_.y_low.value_or(y.low), options_.y_high.value_or(y.high), rows);
    if (options_.y_low) frame.y.low = *options_.y_low;
    if (options_.y_high) frame.y.high = *options_.y_high;
    frame.x = {options_.x_low.value_or(x.low), options_.x_high.value_or(x.high)};
    if (options_.nice_x || !(frame.x.low < frame.x.high)) {
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
  frame.width = options_.width - frame.left - 14;
  if (options_.equal_axes) {
    const double span_x = frame.x.high - frame.x.low, span_y = frame.y.high - frame.y.low;
    if (options_.height <= 0) {
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

void Plot::AppendAxes(const Frame& frame, std::string* svg) const {
  const double right = frame.left + frame.width, bottom = frame.top + frame.height;
  const int columns = std::max(4, static_cast<int>(frame.width / 80));
  const int rows = std::max(3, static_cast<int>(frame.height / 40));
  Ticks x = NiceTicks(frame.x.low, frame.x.high, columns);
  Ticks y = NiceTicks(frame.y.low, frame.y.high, rows);
  if (options_.equal_axes && x.step != y.step) {  // one grid of squares, where it has enough rows
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
  if (options_.equal_axes) {
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
  if (!options_.title.empty()) *svg += PixelText(2, 14, "", "title", options_.title);
  const double header = options_.title.empty() ? 14 : kTitleHeight + 12;
  if (!options_.y_label.empty()) *svg += PixelText(2, header, "", "label", options_.y_label);
  if (!options_.x_label.empty()) {
    *svg += PixelText(frame.left + 0.5 * frame.width, frame.picture_height - 5, "middle", "label",
                      options_.x_label);
  }
}

void Plot::AppendLegend(const Frame& frame, std::string* svg) const {
  std::vector<const Shape*> entries;
  double needed = 0;
  for (const Shape& shape : shapes_) {
    if (shape.style.label.empty()) continue;
    entries.push_back(&shape);
    needed += 24 + TextWidth(shape.style.label) + 14;
  }
  // On the line of the y label, right-aligned.
  const double v = (options_.title.empty() ? 14 : kTitleHeight + 12) - 4;
  double u = std::max(TextWidth(options_.y_label) + 24, frame.left + frame.width - needed + 14);
  for (const Shape* shape : entries) {
    const PlotStyle& style = shape->style;
    if (shape->kind == Kind::kBand || shape->kind == Kind::kBars) {
      *svg += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"18\" height=\"9\"{}/>", Coordinate(u),
                          Coordinate(v - 4.5), Fill(style));
    } else if (shape->kind == Kind::kPoints) {
      *svg += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"3\"{}/>", Coordinate(u + 9),
                          Coordinate(v), Fill({.color = style.color}));
    } else if (shape->kind == Kind::kArrow) {
      *svg += fmt::format("<path d=\"M{} {}l10 4l-10 4l2.5-4z\"{}/>", Coordinate(u + 4),
                          Coordinate(v - 4), Fill({.color = style.color}));
    } else {
      *svg += fmt::format("<path d=\"M{} {}h18\"{}/>", Coordinate(u), Coordinate(v), Stroke(style));
    }
    *svg += PixelText(u + 24, v + 4, "", "label", style.label);
    u += 24 + TextWidth(style.label) + 14;
  }
}

void Plot::AppendShape(const Frame& frame, const Shape& shape, std::string* svg) {
  const PlotStyle& style = shape.style;
  switch (shape.kind) {
    case Kind::kLine: {
      std::string path;
      for (const auto& piece : FinitePieces(frame.Local(shape.points))) {
        path += PathOf(SimplifyLine(piece, kTolerancePx, kMostLinePoints));
      }
      if (path.empty()) return;
      *svg += fmt::format("<path d=\"{}\"{} stroke-linejoin=\"round\" stroke-linecap=\"round\"/>",
                          path, Stroke(style));
      return;
    }
    case Kind::kBand: {
      const auto lower = FinitePieces(frame.Local(shape.points));
      const auto upper = FinitePieces(frame.Local(shape.upper));
      std::string path;
      for (std::size_t k = 0; k < lower.size(); ++k) {
        auto outline = SimplifyLine(lower[k], kTolerancePx, kMostLinePoints);
        const auto back = SimplifyLine(upper[k], kTolerancePx, kMostLinePoints);
        outline.insert(outline.end(), back.rbegin(), back.rend());
        path += PathOf(outline) + "z";
      }
      if (path.empty()) return;
      *svg += fmt::format("<path d=\"{}\"{}/>", path, Fill(style));
      return;
    }
    case Kind::kPoints: {
      std::string path;
      for (const Vec2d& p : ThinOut(frame.Local(shape.points), kMostScatterPoints)) {
        if (IsFinite(p)) path += fmt::format("M{} {}h0", Coordinate(p.x), Coordinate(p.y));
      }
      if (path.empty()) return;
      *svg += fmt::format("<path d=\"{}\"{} stroke-linecap=\"round\"/>", path, Stroke(style));
      return;
    }
    case Kind::kBars: {
      std::string path;
      for (const Vec2d& p : shape.points) {
        if (!(p.y > 0)) continue;
        const Vec2d corner = frame.Local(p), end = frame.Local({p.x + shape.bar_width, 0});
        path += fmt::format("M{} {}H{}V{}H{}z", Coordinate(corner.x + 0.5), Coordinate(corner.y),
                            Coordinate(end.x - 0.5), Coordinate(end.y), Coordinate(corner.x + 0.5));
      }
      if (path.empty()) return;
      *svg += fmt::format("<path d=\"{}\"{}/>", path, Fill(style));
      return;
    }
    case Kind::kArrow: {
      const Vec2d at = frame.Local(shape.points[0]);
      const Vec2d& direction = shape.points[1];
      // Pixels per unit differ between the axes unless they are equal.
      const double dx = direction.x * frame.width / (frame.x.high - frame.x.low);
      const double dy = -direction.y * frame.height / (frame.y.high - frame.y.low);
      const double length = std::hypot(dx, dy);
      if (!IsFinite(at)) return;
      if (!(length > 1e-9)) {
        *svg += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}/>", Coordinate(at.x),
                            Coordinate(at.y), Coordinate(0.25 * style.width), Fill(style));
        return;
      }
      const double s = 0.5 * style.width, ex = dx / length * s, ey = dy / length * s;
      *svg += fmt::format("<path d=\"{}z\"{} class=\"arrow\"/>",
                          PathOf({{at.x + 1.2 * ex, at.y + 1.2 * ey},
                                  {at.x - ex - 0.7 * ey, at.y - ey + 0.7 * ex},
                                  {at.x - 0.5 * ex, at.y - 0.5 * ey},
                                  {at.x - ex + 0.7 * ey, at.y - ey - 0.7 * ex}}),
                          Fill(style));
      return;
    }
    case Kind::kText: {
      const Vec2d at = frame.Local(shape.points[0]);
      if (IsFinite(at)) *svg += PixelText(at.x + 10, at.y + 4, "", "label halo", shape.text);
      return;
    }
    case Kind::kVertical: {
      const double u = frame.Local({shape.points[0].x, 0}).x;
      *svg += fmt::format("<path d=\"M{} 0v{}\"{}/>", Coordinate(u), Coordinate(frame.height),
                          Stroke(style));
      return;
    }
    case Kind::kHorizontal: {
      const double v = frame.Local({0, shape.points[0].y}).y;
      *svg += fmt::format("<path d=\"M0 {}h{}\"{}/>", Coordinate(v), Coordinate(frame.width),
                          Stroke(style));
      return;
    }
  }
}

std::string Plot::Svg() const {
  const Frame frame = MakeFrame();
  std::string svg =
      fmt::format("<svg class=\"plot{}\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">",
                  options_.width > 700 ? " wide" : "", Coordinate(options_.width),
                  Coordinate(frame.picture_height), EscapeMarkup(options_.title));
  AppendAxes(frame, &svg);
  svg += fmt::format("<svg x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\">", Coordinate(frame.left),
                     Coordinate(frame.top), Coordinate(frame.width), Coordinate(frame.height));
  for (const Shape& shape : shapes_) AppendShape(frame, shape, &svg);
  svg += "</svg>";
  AppendLegend(frame, &svg);
  return svg + "</svg>\n";
}

}  // namespace flocklift
