// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/convex_polygon.h"

#include <algorithm>

#include "simulate/core/check.h"

namespace flocklift {

ConvexPolygon HullOf(std::span<const Vec2d> points) {
  FLOCKLIFT_DCHECK(points.size() <= ConvexPolygon::kMaxCorners);
  std::array<Vec2d, ConvexPolygon::kMaxCorners> sorted;
  const auto end = std::copy(points.begin(), points.end(), sorted.begin());
  std::sort(sorted.begin(), end,
            [](const Vec2d& a, const Vec2d& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  // Monotone chain (Andrew 1979): the lower side from left to right, then the upper side back.
  const int n = static_cast<int>(points.size());
  std::array<Vec2d, 2 * ConvexPolygon::kMaxCorners> hull;
  int size = 0;
  const auto add = [&](const Vec2d& p, int keep) {
    const auto at = [&](int k) { return hull[static_cast<std::size_t>(k)]; };
    while (size >= keep + 2) {
      const Vec2d a = at(size - 2), b = at(size - 1);
      if ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) > 0) break;
      --size;
    }
    hull[static_cast<std::size_t>(size++)] = p;
  };
  for (int k = 0; k < n; ++k) add(sorted[static_cast<std::size_t>(k)], 0);
  const int lower = size - 1;
  for (int k = n - 2; k >= 0; --k) add(sorted[static_cast<std::size_t>(k)], lower);
  ConvexPolygon polygon;
  for (int k = 0; k < std::max(size - 1, std::min(n, 1)); ++k) {
    polygon.Add(hull[static_cast<std::size_t>(k)]);
  }
  return polygon;
}

}  // namespace flocklift
