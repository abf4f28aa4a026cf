// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/plot/simplify.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

double DistanceToSegment(const Vec2d& p, const Vec2d& a, const Vec2d& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double squared = dx * dx + dy * dy;
  double t = 0;
  if (squared > 0) t = std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0.0, 1.0);
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

// The lowest and the highest point of each of `pieces` equal pieces, in their order.
std::vector<Vec2d> ExtremesOfPieces(const std::vector<Vec2d>& points, std::size_t pieces) {
  std::vector<Vec2d> kept = {points.front()};
  const std::size_t inner = points.size() - 2;
  for (std::size_t piece = 0; piece < pieces; ++piece) {
    const auto begin = points.begin() + 1 + static_cast<long>(inner * piece / pieces);
    const auto end = points.begin() + 1 + static_cast<long>(inner * (piece + 1) / pieces);
    if (begin == end) continue;
    auto [low, high] =
        std::minmax_element(begin, end, [](const Vec2d& a, const Vec2d& b) { return a.y < b.y; });
    if (high < low) std::swap(low, high);
    kept.push_back(*low);
    if (high != low) kept.push_back(*high);
  }
  kept.push_back(points.back());
  return kept;
}

}  // namespace

std::vector<Vec2d> SimplifyLine(const std::vector<Vec2d>& points, double tolerance,
                                std::size_t most) {
  Check(most >= 4, "a simplified line keeps at least 4 points");
  if (points.size() < 3) return points;
  // Far more points than pixels: bound the work of what follows.
  if (points.size() > 16 * most) {
    return SimplifyLine(ExtremesOfPieces(points, 4 * most), tolerance, most);
  }
  std::vector<bool> keep(points.size(), false);
  keep.front() = keep.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open = {{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    std::size_t farthest = first;
    double distance = tolerance;
    for (std::size_t k = first + 1; k < last; ++k) {
      const double d = DistanceToSegment(points[k], points[first], points[last]);
      if (d > distance) {
        distance = d;
        farthest = k;
      }
    }
    if (farthest == first) continue;
    keep[farthest] = true;
    open.emplace_back(first, farthest);
    open.emplace_back(farthest, last);
  }
  std::vector<Vec2d> kept;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (keep[k]) kept.push_back(points[k]);
  }
  return kept.size() <= most ? kept : ExtremesOfPieces(kept, most / 2 - 1);
}

std::vector<Vec2d> ThinOut(const std::vector<Vec2d>& points, std::size_t most) {
  if (points.size() <= most) return points;
  std::vector<Vec2d> kept;
  kept.reserve(most);
  for (std::size_t k = 0; k < most; ++k) kept.push_back(points[k * points.size() / most]);
  return kept;
}

}  // namespace flocklift
