// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/convex_polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

TEST(HullOf, HoldsAllPointsAndIsConvex) {
  for (std::uint64_t trial = 0; trial < 100; ++trial) {
    Rng rng(12, trial);
    std::vector<Vec2d> points;
    const int n = 1 + static_cast<int>(rng.Below(ConvexPolygon::kMaxCorners));
    for (int k = 0; k < n; ++k) {
      points.push_back(trial % 2 == 0 ? Vec2d{rng.Normal(), rng.Normal()}
                                      : Vec2d{double(rng.Below(3)), double(rng.Below(3))});
    }
    const ConvexPolygon hull = HullOf(points);
    ASSERT_GE(hull.corners, 1);
    ASSERT_LE(hull.corners, n);
    for (int k = 0; k < hull.corners; ++k) {
      const Vec2d a = hull.corner[k], b = hull.corner[(k + 1) % hull.corners];
      EXPECT_NE(std::find(points.begin(), points.end(), a), points.end());
      for (const Vec2d& p : points) {
        EXPECT_GE((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x), -1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace flocklift
