// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/plot/draw_shape.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "tools/plot/markup.h"
#include "tools/plot/simplify.h"
#include "tools/plot/svg_parts.h"

namespace flocklift {
namespace {

constexpr std::size_t kMostLinePoints = 3000, kMostScatterPoints = 4000;
constexpr double kTolerancePx = 0.25;

bool IsFinite(const Vec2d& p) { return std::isfinite(p.x) && std::isfinite(p.y); }

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

}  // namespace

void AppendShape(const PlotFrame& frame, const PlotShape& shape, std::string* svg) {
  const PlotStyle& style = shape.style;
  switch (shape.kind) {
    case PlotShape::Kind::kLine: {
      std::string path;
      for (const auto& piece : FinitePieces(frame.Local(shape.points))) {
        path += PathOf(SimplifyLine(piece, kTolerancePx, kMostLinePoints));
      }
      if (path.empty()) return;
      *svg += fmt::format("<path d=\"{}\"{} stroke-linejoin=\"round\" stroke-linecap=\"round\"/>",
                          path, Stroke(style));
      return;
    }
    case PlotShape::Kind::kBand: {
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
    case PlotShape::Kind::kPoints: {
      std::string path;
      for (const Vec2d& p : ThinOut(frame.Local(shape.points), kMostScatterPoints)) {
        if (IsFinite(p)) path += fmt::format("M{} {}h0", Coordinate(p.x), Coordinate(p.y));
      }
      if (path.empty()) return;
      *svg += fmt::format("<path d=\"{}\"{} stroke-linecap=\"round\"/>", path, Stroke(style));
      return;
    }
    case PlotShape::Kind::kBars: {
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
    case PlotShape::Kind::kArrow: {
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
    case PlotShape::Kind::kText: {
      const Vec2d at = frame.Local(shape.points[0]);
      if (IsFinite(at)) *svg += PixelText(at.x + 10, at.y + 4, "", "label halo", shape.text);
      return;
    }
    case PlotShape::Kind::kVertical: {
      const double u = frame.Local({shape.points[0].x, 0}).x;
      *svg += fmt::format("<path d=\"M{} 0v{}\"{}/>", Coordinate(u), Coordinate(frame.height),
                          Stroke(style));
      return;
    }
    case PlotShape::Kind::kHorizontal: {
      const double v = frame.Local({0, shape.points[0].y}).y;
      *svg += fmt::format("<path d=\"M0 {}h{}\"{}/>", Coordinate(v), Coordinate(frame.width),
                          Stroke(style));
      return;
    }
  }
}

void AppendSample(const PlotShape& shape, double u, double v, std::string* svg) {
  const PlotStyle& style = shape.style;
  if (shape.kind == PlotShape::Kind::kBand || shape.kind == PlotShape::Kind::kBars) {
    *svg += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"18\" height=\"9\"{}/>", Coordinate(u),
                        Coordinate(v - 4.5), Fill(style));
  } else if (shape.kind == PlotShape::Kind::kPoints) {
    *svg += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"3\"{}/>", Coordinate(u + 9), Coordinate(v),
                        Fill({.color = style.color}));
  } else if (shape.kind == PlotShape::Kind::kArrow) {
    *svg += fmt::format("<path d=\"M{} {}l10 4l-10 4l2.5-4z\"{}/>", Coordinate(u + 4),
                        Coordinate(v - 4), Fill({.color = style.color}));
  } else {
    *svg += fmt::format("<path d=\"M{} {}h18\"{}/>", Coordinate(u), Coordinate(v), Stroke(style));
  }
}

}  // namespace flocklift
