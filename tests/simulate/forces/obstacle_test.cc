// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/forces/obstacle.h"

#include <gtest/gtest.h>

#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

// in: range, distance, normal, velocity.
struct Avoid {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    return ObstacleAvoidance::Turn(ObstacleAvoidance::Params<T>{in[0]}, in[1],
                                   Vec3<T>{in[2], in[3], in[4]}, Vec3<T>{in[5], in[6], in[7]});
  }
};

TEST(ObstacleRamp, PinsOfThePaper) {
  EXPECT_EQ(ObstacleRamp(0.0), 0);
  EXPECT_EQ(ObstacleRamp(1.0), 1);
  EXPECT_EQ(ObstacleRamp(-3.0), 0);
  EXPECT_EQ(ObstacleRamp(3.0), 1);
  EXPECT_NEAR((ObstacleRamp(1.0) - ObstacleRamp(1 - 1e-4)) / 1e-4, 0, 1e-6);  // ramp'(1) = 0
  EXPECT_NEAR(ObstacleRamp(1e-6) / 1e-6, 1.875, 1e-6);
}

TEST(ObstacleAvoidance, AtTheWallNothingFliesIn) {
  const std::array in{2.0, 0.0, 0.6, 0.0, 0.8, -3.0, 5.0, -1.0};
  const Vec3d turned = Evaluate<double>(Avoid{}, in);
  EXPECT_NEAR(Dot(turned, Vec3d{0.6, 0, 0.8}), 0, 1e-12);
  EXPECT_EQ(turned.y, 5);
}

TEST(ObstacleAvoidance, LeavesAloneWhatIsFarOrFliesAway) {
  const auto turned = [](double distance, double vz) {
    return Evaluate<double>(Avoid{}, std::array{2.0, distance, 0.0, 0.0, 1.0, 1.0, 2.0, vz});
  };
  EXPECT_EQ(turned(2.5, -3), (Vec3d{1, 2, -3}));
  EXPECT_EQ(turned(0, 3), (Vec3d{1, 2, 3}));
  EXPECT_EQ(turned(-1, -3), (Vec3d{1, 2, 0}));  // inside: not deeper
  const double half = turned(1, -3).z;
  EXPECT_NEAR(half, -3 * (15.0 / 16 - 10.0 / 64 + 3.0 / 256), 1e-12);
}

TEST(ObstacleAvoidance, ScalarsAgreeAndGradient) {
  for (const auto& in : {std::array{2.0, 0.7, 0.6, 0.0, 0.8, -3.0, 5.0, -1.0},
                         std::array{2.0, 0.7, 0.6, 0.0, 0.8, 3.0, 5.0, 1.0}}) {
    ExpectScalarsAgree(Avoid{}, in);
    ExpectGradientMatches(Avoid{}, in);
  }
}

}  // namespace
}  // namespace flocklift
