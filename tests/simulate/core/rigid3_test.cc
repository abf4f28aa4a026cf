// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/rigid3.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

void ExpectNear(const Vec3d& a, const Vec3d& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(LookAt, SeesItsTargetStraightAhead) {
  const Rigid3d cam_from_world = LookAt({1, 2, 3}, {1, 12, 3});
  ExpectNear(cam_from_world * Vec3d{1, 12, 3}, {0, 0, 10}, 1e-12);
  ExpectNear(cam_from_world * Vec3d{2, 12, 3}, {1, 0, 10}, 1e-12);   // world +x is to the right
  ExpectNear(cam_from_world * Vec3d{1, 12, 4}, {0, -1, 10}, 1e-12);  // world up is image up
}

TEST(LookAt, StraightUpIsStillARotation) {
  const Rigid3d cam_from_world = LookAt({0, 0, 0}, {0, 0, 5});
  ExpectNear(cam_from_world * Vec3d{0, 0, 5}, {0, 0, 5}, 1e-12);
}

TEST(Rigid3, InverseUndoes) {
  const Rigid3d cam_from_world = LookAt({3, -1, 2}, {0, 4, 9});
  ExpectNear(cam_from_world.Inverse() * (cam_from_world * Vec3d{5, 6, 7}), {5, 6, 7}, 1e-12);
}

TEST(Quaternion, RoundTripThroughRotations) {
  Rng rng(5);
  for (int k = 0; k < 200; ++k) {
    Quaternion q{rng.Normal(), rng.Normal(), rng.Normal(), rng.Normal()};
    const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    const double sign = q.w < 0 ? -1 : 1;
    q = {sign * q.w / norm, sign * q.x / norm, sign * q.y / norm, sign * q.z / norm};
    const Quaternion back = QuaternionFromRotation(RotationFromQuaternion(q));
    EXPECT_NEAR(back.w, q.w, 1e-9);
    EXPECT_NEAR(back.x, q.x, 1e-9);
    EXPECT_NEAR(back.y, q.y, 1e-9);
    EXPECT_NEAR(back.z, q.z, 1e-9);
  }
}

TEST(WorldFromLevelBody, FliesAheadWithLevelWings) {
  const Rotation3d world_from_body = WorldFromLevelBody({3, 0, 4});
  ExpectNear(world_from_body * Vec3d{1, 0, 0}, {0.6, 0, 0.8}, 1e-12);
  EXPECT_NEAR((world_from_body * Vec3d{0, 1, 0}).z, 0, 1e-12);  // wings level
  EXPECT_GT((world_from_body * Vec3d{0, 0, 1}).z, 0);           // back up
}

}  // namespace
}  // namespace flocklift
