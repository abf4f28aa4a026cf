// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Convex polygons in the image, with few corners, and the hull of points.

#ifndef FLOCKLIFT_SIMULATE_RENDER_CONVEX_POLYGON_H_
#define FLOCKLIFT_SIMULATE_RENDER_CONVEX_POLYGON_H_

#include <array>
#include <span>

#include "simulate/core/vec3.h"

namespace flocklift {

// Corners in order, in either sense of rotation [px]. May be degenerate (seen edge-on).
struct ConvexPolygon {
  static constexpr int kMaxCorners = 12;
  std::array<Vec2d, kMaxCorners> corner;
  int corners = 0;

  void Add(const Vec2d& point) { corner[static_cast<std::size_t>(corners++)] = point; }
};

// The smallest convex polygon around at most kMaxCorners points.
ConvexPolygon HullOf(std::span<const Vec2d> points);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_RENDER_CONVEX_POLYGON_H_
