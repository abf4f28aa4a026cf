// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/orientation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flocklift {
namespace {

const Vec3d kUp{0, 0, 1};

void ExpectNear(const Vec3d& a, const Vec3d& b) { EXPECT_LT(Norm(a - b), 1e-12); }

void ExpectRotation(const Rotation3d& r) {
  const Vec3d x = r * Vec3d{1, 0, 0}, y = r * Vec3d{0, 1, 0}, z = r * Vec3d{0, 0, 1};
  ExpectNear(Cross(x, y), z);
  EXPECT_NEAR(Norm(x), 1, 1e-12);
  EXPECT_NEAR(Norm(y), 1, 1e-12);
  EXPECT_NEAR(Dot(x, y), 0, 1e-12);
}

TEST(Orientation, StraightFlightIsLevel) {
  const Rotation3d r = WorldFromFlyingBody({0, 5, 0}, {}, kUp);
  ExpectNear(r * Vec3d{1, 0, 0}, {0, 1, 0});
  ExpectNear(r * Vec3d{0, 1, 0}, {-1, 0, 0});
  ExpectNear(r * Vec3d{0, 0, 1}, kUp);
}

// 9.81 m/s^2 to the left: a bank of 45 degrees, the body's up leans into the turn.
TEST(Orientation, ACoordinatedTurnBanks) {
  const Rotation3d r = WorldFromFlyingBody({10, 0, 0}, {0, 9.81, 0}, kUp);
  ExpectNear(r * Vec3d{0, 0, 1}, {0, std::sqrt(0.5), std::sqrt(0.5)});
  ExpectNear(r * Vec3d{1, 0, 0}, {1, 0, 0});
  ExpectRotation(r);
}

TEST(Orientation, ABankHasItsLimit) {
  const Rotation3d r = WorldFromFlyingBody({10, 0, 0}, {0, -1e6, 0}, kUp);
  EXPECT_NEAR((r * Vec3d{0, 0, 1}).z, std::cos(70 * 3.14159265358979 / 180), 1e-3);
}

TEST(Orientation, NothingIsSingular) {
  ExpectRotation(WorldFromFlyingBody({}, {}, kUp));
  ExpectRotation(WorldFromFlyingBody({0, 0, 3}, {1, 0, 0}, kUp));
  ExpectRotation(WorldFromFlyingBody({0, 0, -3}, {}, {0, 0, 1}));
  ExpectRotation(WorldFromFlyingBody({1, 0, 0}, {}, {1, 0, 0}));
}

}  // namespace
}  // namespace flocklift
