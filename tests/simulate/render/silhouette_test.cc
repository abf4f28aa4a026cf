// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/silhouette.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

ConvexPolygon Rectangle(double left, double top, double right, double bottom) {
  ConvexPolygon p;
  for (const Vec2d& corner :
       {Vec2d{left, top}, Vec2d{right, top}, Vec2d{right, bottom}, Vec2d{left, bottom}}) {
    p.Add(corner);
  }
  return p;
}

// Corners on an ellipse, in order: convex.
ConvexPolygon RandomPolygon(Rng* rng) {
  const Vec2d center{rng->Uniform(-5, 5), rng->Uniform(-5, 5)};
  const double a = rng->Uniform(1, 8), b = rng->Uniform(0.3, 5), tilt = rng->Uniform(0, 3);
  const int corners = 3 + static_cast<int>(rng->Below(6));
  std::vector<double> angles;
  for (int k = 0; k < corners; ++k) angles.push_back(rng->Uniform(0, 2 * std::numbers::pi));
  std::sort(angles.begin(), angles.end());
  if (rng->Below(2) == 0) std::reverse(angles.begin(), angles.end());
  ConvexPolygon p;
  for (double angle : angles) {
    const double x = a * std::cos(angle), y = b * std::sin(angle);
    p.Add({center.x + x * std::cos(tilt) - y * std::sin(tilt),
           center.y + x * std::sin(tilt) + y * std::cos(tilt)});
  }
  return p;
}

bool Contains(const ConvexPolygon& p, double x, double y) {
  bool left = false, right = false;
  for (int k = 0; k < p.corners; ++k) {
    const Vec2d a = p.corner[k], b = p.corner[(k + 1) % p.corners];
    const double side = (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
    (side > 0 ? left : right) = true;
  }
  return !(left && right);
}

TEST(SilhouetteTest, MomentsOfARectangle) {
  const std::vector<ConvexPolygon> polygons{Rectangle(1000, 2000, 1006, 2002)};
  const SilhouetteMoments m = MomentsOf(UnionOf(polygons));
  EXPECT_NEAR(m.area, 12, 1e-9);
  EXPECT_NEAR(m.centroid.x, 1003, 1e-9);
  EXPECT_NEAR(m.centroid.y, 2001, 1e-9);
  EXPECT_NEAR(m.xx, 36.0 / 12, 1e-9);
  EXPECT_NEAR(m.yy, 4.0 / 12, 1e-9);
  EXPECT_NEAR(m.xy, 0, 1e-9);
}

TEST(SilhouetteTest, OverlapsCountOnce) {
  // An L of two bars, one of them given twice.
  const std::vector<ConvexPolygon> polygons{Rectangle(0, 0, 2, 6), Rectangle(0, 4, 8, 6),
                                            Rectangle(0, 0, 2, 6)};
  const Silhouette l = UnionOf(polygons);
  const SilhouetteMoments m = MomentsOf(l);
  EXPECT_NEAR(m.area, 8 + 16, 1e-9);
  EXPECT_NEAR(m.centroid.x, (8 * 1 + 16 * 4) / 24.0, 1e-9);
  EXPECT_NEAR(m.centroid.y, (8 * 2 + 16 * 5) / 24.0, 1e-9);
  const Box box = BoundsOf(l);
  EXPECT_EQ(box.left, 0);
  EXPECT_EQ(box.top, 0);
  EXPECT_EQ(box.width, 8);
  EXPECT_EQ(box.height, 6);
}

// Brute force: the moments of a fine grid of points.
TEST(SilhouetteTest, UnionAgreesWithSampling) {
  for (std::uint64_t trial = 0; trial < 6; ++trial) {
    Rng rng(31, trial);
    std::vector<ConvexPolygon> polygons;
    for (int k = 0; k < 6; ++k) polygons.push_back(RandomPolygon(&rng));
    const SilhouetteMoments m = MomentsOf(UnionOf(polygons));

    constexpr double kStep = 0.04;
    double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    for (double v = -14; v < 14; v += kStep) {
      for (double u = -14; u < 14; u += kStep) {
        if (std::none_of(polygons.begin(), polygons.end(),
                         [&](const ConvexPolygon& p) { return Contains(p, u, v); })) {
          continue;
        }
        n += 1;
        x += u;
        y += v;
        xx += u * u;
        xy += u * v;
        yy += v * v;
      }
    }
    ASSERT_GT(n, 0);
    EXPECT_NEAR(m.area, n * kStep * kStep, 0.008 * m.area) << trial;
    EXPECT_NEAR(m.centroid.x, x / n, 0.02) << trial;
    EXPECT_NEAR(m.centroid.y, y / n, 0.02) << trial;
    EXPECT_NEAR(m.xx, xx / n - x / n * x / n, 0.01 * m.xx + 0.01) << trial;
    EXPECT_NEAR(m.yy, yy / n - y / n * y / n, 0.01 * m.yy + 0.01) << trial;
    EXPECT_NEAR(m.xy, xy / n - x / n * y / n, 0.01 * (m.xx + m.yy) + 0.01) << trial;
  }
}

TEST(SilhouetteTest, ShiftMovesEverything) {
  Rng rng(5);
  std::vector<ConvexPolygon> polygons{RandomPolygon(&rng), RandomPolygon(&rng)};
  Silhouette silhouette = UnionOf(polygons);
  const SilhouetteMoments before = MomentsOf(silhouette);
  silhouette.Shift({100.25, -7.5});
  const SilhouetteMoments after = MomentsOf(silhouette);
  EXPECT_NEAR(after.area, before.area, 1e-9);
  EXPECT_NEAR(after.centroid.x, before.centroid.x + 100.25, 1e-9);
  EXPECT_NEAR(after.centroid.y, before.centroid.y - 7.5, 1e-9);
  EXPECT_NEAR(after.xy, before.xy, 1e-8);
}

TEST(SilhouetteTest, NothingHasNoArea) {
  EXPECT_EQ(MomentsOf(UnionOf({})).area, 0);
  const std::vector<ConvexPolygon> flat{Rectangle(0, 3, 5, 3)};
  EXPECT_EQ(MomentsOf(UnionOf(flat)).area, 0);
  EXPECT_EQ(BoundsOf(UnionOf({})).width, 0);
}

TEST(SilhouetteTest, ShapeOfATiltedEllipse) {
  constexpr double kTilt = 0.4, kA = 10, kB = 3;
  ConvexPolygon p;
  for (int k = 0; k < ConvexPolygon::kMaxCorners; ++k) {
    const double angle = 2 * std::numbers::pi * k / ConvexPolygon::kMaxCorners;
    const double x = kA * std::cos(angle), y = kB * std::sin(angle);
    p.Add({x * std::cos(kTilt) - y * std::sin(kTilt), x * std::sin(kTilt) + y * std::cos(kTilt)});
  }
  const std::vector<ConvexPolygon> polygons{p};
  const Shape shape = ShapeOf(MomentsOf(UnionOf(polygons)));
  // A 12-sided polygon is a little smaller than its ellipse, whose axis is 4 sd = 2 a.
  EXPECT_NEAR(shape.major, 2 * kA, 0.07 * 2 * kA);
  EXPECT_NEAR(shape.minor, 2 * kB, 0.07 * 2 * kB);
  EXPECT_NEAR(shape.angle_deg, kTilt * 180 / std::numbers::pi, 1e-6);
  EXPECT_NEAR(shape.area, std::numbers::pi * kA * kB, 0.05 * std::numbers::pi * kA * kB);
}

}  // namespace
}  // namespace flocklift
