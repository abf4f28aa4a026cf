// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/obstacle_avoidance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

TEST(AvoidObstacle, ByHand) {
  // Flying down and ahead at a floor, half-way through its range.
  const Vec3d v = AvoidObstacle({3, 0, -4}, 0.5, {0, 0, 1}, 1, 10);
  EXPECT_NEAR(v.x, 0.5 * 3 + 0.5 * 10, 1e-12);
  EXPECT_NEAR(v.y, 0, 1e-12);
  EXPECT_NEAR(v.z, 0.5 * -4, 1e-12);
}

TEST(AvoidObstacle, AtTheSurfaceOnlyAlongIt) {
  Rng rng(2);
  for (int k = 0; k < 100; ++k) {
    const Vec3d outwards = Normalized({rng.Normal(), rng.Normal(), rng.Normal()});
    const Vec3d v = AvoidObstacle({rng.Normal(), rng.Normal(), rng.Normal()}, 0, outwards, 0.3, 7);
    EXPECT_NEAR(Dot(v, outwards), 0, 1e-12);
    EXPECT_NEAR(Norm(v), 7, 1e-12);
  }
}

TEST(AvoidObstacle, BeyondTheRangeAsWanted) {
  const Vec3d wanted{1, 2, 3};
  for (const double distance : {1.0, 1.5, 100.0}) {  // the weight is held at 1
    EXPECT_EQ(AvoidObstacle(wanted, distance, {0, 0, 1}, 1, 5), wanted);
  }
}

TEST(AvoidObstacle, InsideAsAtTheSurface) {
  EXPECT_EQ(AvoidObstacle({1, 0, -1}, -3, {0, 0, 1}, 1, 5),
            AvoidObstacle({1, 0, -1}, 0, {0, 0, 1}, 1, 5));
}

TEST(AvoidObstacle, StraightAtTheSurfaceSomeWayAlongIt) {
  for (const Vec3d& outwards : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
    const Vec3d v = AvoidObstacle(-4.0 * outwards, 0, outwards, 1, 5);
    EXPECT_NEAR(Norm(v), 5, 1e-12);
    EXPECT_NEAR(Dot(v, outwards), 0, 1e-12);
  }
}

}  // namespace
}  // namespace flocklift
