// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/camera_path.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flocklift::internal {
namespace {

TEST(CameraPath, StandsWithoutPlaces) {
  const CameraMotion motion = CameraPath({}, 30, 0.1).At(2);
  EXPECT_FALSE(motion.moves);
  EXPECT_EQ(motion.velocity, Vec3d{});
}

// A cubic of time is a spline: it and its derivatives come back to rounding.
TEST(CameraPath, FollowsACubic) {
  const auto place = [](double t) { return Vec3d{t * t * t - t, 2 * t, 1 - 0.5 * t * t}; };
  std::vector<Vec3d> places;
  for (int k = 0; k < 100; ++k) places.push_back(place(k / 25.0));
  const CameraPath path(places, 25, 0.1);
  for (const double t : {0.0, 0.33, 1.7, 3.96}) {
    const CameraMotion motion = path.At(t);
    EXPECT_LT(Norm(motion.place - place(t)), 1e-4) << t;
    EXPECT_LT(Norm(motion.velocity - Vec3d{3 * t * t - 1, 2, -t}), 2e-3) << t;
    EXPECT_LT(Norm(motion.acceleration - Vec3d{6 * t, 0, -1}), 5e-2) << t;
  }
}

TEST(CameraPath, OnePlaceDoesNotMove) {
  const CameraMotion motion = CameraPath({{1, 2, 3}}, 30, 0.1).At(0);
  EXPECT_LT(Norm(motion.place - Vec3d{1, 2, 3}), 1e-3);
  EXPECT_LT(Norm(motion.velocity), 1e-2);
}

}  // namespace
}  // namespace flocklift::internal
