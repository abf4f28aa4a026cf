// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/spline_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace flocklift {
namespace {

std::vector<Vec3d> Circle(int count, double radius) {
  std::vector<Vec3d> points;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count;
    points.push_back({radius * std::cos(angle), radius * std::sin(angle), 1});
  }
  return points;
}

const std::vector<Vec3d> kBends{{0, 0, 0}, {10, 0, 1}, {10, 8, 5}, {-3, 8, 2}, {-3, 20, 0}};

TEST(SplinePath, AStraightLine) {
  const SplinePath path({{1, 2, 3}, {1, 2, 13}}, false);
  EXPECT_NEAR(path.length(), 10, 1e-12);
  for (const double s : {0.0, 0.1, 2.5, 9.0, 10.0}) {
    EXPECT_NEAR(Norm(path.Position(s) - Vec3d{1, 2, 3 + s}), 0, 1e-9);
    EXPECT_NEAR(Norm(path.Tangent(s) - Vec3d{0, 0, 1}), 0, 1e-9);
  }
  EXPECT_NEAR(Norm(path.Position(-5) - Vec3d{1, 2, 3}), 0, 1e-9);
  EXPECT_NEAR(Norm(path.Position(50) - Vec3d{1, 2, 13}), 0, 1e-9);
}

TEST(SplinePath, AClosedCircleOfManyPoints) {
  // At a knot the curve is (c_-1 + 4 c_0 + c_1) / 6: a radius of (2 + cos(2 pi / n)) / 3 of theirs.
  const SplinePath path(Circle(60, 5), true);
  const double radius = 5 * (2 + std::cos(2 * std::numbers::pi / 60)) / 3;
  EXPECT_NEAR(path.length(), 2 * std::numbers::pi * radius, 1e-4);
  for (double s = 0; s < 40; s += 0.7) {
    const Vec3d p = path.Position(s);
    EXPECT_NEAR(std::hypot(p.x, p.y), radius, 1e-4);
    EXPECT_NEAR(p.z, 1, 1e-12);
    EXPECT_NEAR(Norm(path.Position(s + path.length()) - p), 0, 1e-6);
    EXPECT_NEAR(Dot(path.Tangent(s), Vec3d{p.x, p.y, 0}), 0, 1e-3);
  }
}

TEST(SplinePath, SpeedIsConstant) {
  for (const bool closed : {false, true}) {
    const SplinePath path(kBends, closed);
    const double step = path.length() / 5000;
    for (int k = 0; k < 5000; ++k) {
      const double way = Norm(path.Position((k + 1) * step) - path.Position(k * step));
      EXPECT_NEAR(way / step, 1, 2e-3) << k;  // a chord is a little shorter than its arc
    }
  }
}

TEST(SplinePath, LengthIsThatOfItsChords) {
  const SplinePath path(kBends, false);
  double chords = 0;
  for (int k = 0; k < 5000; ++k) {
    chords += Norm(path.Position((k + 1) * path.length() / 5000) -
                   path.Position(k * path.length() / 5000));
  }
  EXPECT_NEAR(chords, path.length(), 1e-5 * path.length());
  EXPECT_NEAR(Norm(path.Position(0) - kBends.front()), 0, 1e-9);
  EXPECT_NEAR(Norm(path.Position(path.length()) - kBends.back()), 0, 1e-9);
}

TEST(SplinePath, TheFrameFollowsThePath) {
  const SplinePath path(kBends, false);
  for (double s = 0; s <= path.length(); s += 0.5) {
    const Rigid3d world_from_path = path.WorldFromPath(s);
    const Vec3d x = world_from_path.rotation * Vec3d{1, 0, 0};
    const Vec3d y = world_from_path.rotation * Vec3d{0, 1, 0};
    const Vec3d z = world_from_path.rotation * Vec3d{0, 0, 1};
    EXPECT_NEAR(Norm(x - path.Tangent(s)), 0, 1e-9);
    EXPECT_NEAR(Norm(Cross(x, y) - z), 0, 1e-9);
    EXPECT_NEAR(y.z, 0, 1e-9);
    EXPECT_GT(z.z, 0);
    EXPECT_NEAR(Norm(world_from_path * Vec3d{} - path.Position(s)), 0, 1e-12);
  }
  const SplinePath up({{0, 0, 0}, {0, 0, 1}}, false);
  EXPECT_NEAR(Norm(up.WorldFromPath(0.5).rotation * Vec3d{0, 1, 0} - Vec3d{0, 1, 0}), 0, 1e-9);
}

TEST(SplinePath, RefusesWhatIsNoPath) {
  EXPECT_THROW(SplinePath({{1, 1, 1}}, false), std::invalid_argument);
  EXPECT_THROW(SplinePath({{1, 1, 1}, {2, 1, 1}}, true), std::invalid_argument);
  EXPECT_THROW(SplinePath({{1, 1, 1}, {1, 1, 1}}, false), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
