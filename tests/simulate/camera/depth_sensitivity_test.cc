// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/camera/depth_sensitivity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "simulate/camera/camera.h"
#include "simulate/camera/projection.h"
#include "simulate/core/rng.h"

namespace flocklift {
namespace {

constexpr double kError = 1e-4;

struct Bird {
  Vec3d position, velocity;  // in the camera frame
};

std::vector<Bird> Flock(double along_axis) {
  Rng rng(1);
  std::vector<Bird> birds(200);
  for (Bird& bird : birds) {
    bird.position = {rng.Uniform(-10, 10), rng.Uniform(-10, 10), rng.Uniform(30, 60)};
    bird.velocity = {rng.Normal(), rng.Normal(), along_axis * rng.Normal()};
  }
  return birds;
}

double MeanSpeed(const std::vector<Bird>& birds) {
  double sum = 0;
  for (const Bird& bird : birds) sum += Norm(bird.velocity);
  return sum / static_cast<double>(birds.size());
}

// Stretching the scene by 1 + e is what a focal length of (1 + e) f cannot see; then the scale is
// set so that the mean speed is right.
TEST(StretchFromSpeed, IsWhatRescalingTheStretchedSceneGives) {
  const Intrinsics right{1000, 1000, 0, 0, {}};
  const Intrinsics wrong{1000 * (1 + kError), 1000 * (1 + kError), 0, 0, {}};
  for (const double along_axis : {0.0, 0.5, 1.0, 3.0}) {
    const std::vector<Bird> birds = Flock(along_axis);
    std::vector<Bird> stretched = birds;
    double share = 0;
    for (Bird& bird : stretched) {
      const Vec2d before = Project(right, bird.position);
      share += bird.velocity.z * bird.velocity.z / Norm(bird.velocity);
      bird.position.z *= 1 + kError;
      bird.velocity.z *= 1 + kError;
      const Vec2d after = Project(wrong, bird.position);
      ASSERT_NEAR(before.x, after.x, 1e-9);
      ASSERT_NEAR(before.y, after.y, 1e-9);
    }
    share /= static_cast<double>(birds.size()) * MeanSpeed(birds);
    const double scale = MeanSpeed(birds) / MeanSpeed(stretched);
    const StretchError error = StretchFromSpeed(kError, share);
    EXPECT_NEAR(scale * (1 + kError) - 1, error.depth, 3 * kError * kError);
    EXPECT_NEAR(scale - 1, error.across, 3 * kError * kError);
  }
}

// A bird of known wingspan S that looks w pixels wide stands at z = f S / w.
TEST(StretchFromSize, MovesDepthAndNothingElse) {
  const double f = 1000, wingspan = 0.7, z = 40, x = 5;
  const double width_px = f * wingspan / z, u = f * x / z;
  const double wrong_f = f * (1 + kError), wrong_z = wrong_f * wingspan / width_px;
  EXPECT_NEAR(wrong_z / z - 1, StretchFromSize(kError).depth, 1e-12);
  EXPECT_NEAR(wrong_z * u / wrong_f / x - 1, StretchFromSize(kError).across, 1e-12);
}

TEST(StretchFromDistances, MovesWhatIsAcross) {
  const double f = 1000, z = 40, x = 5, u = f * x / z;
  EXPECT_EQ(StretchFromDistances(kError).depth, 0);
  EXPECT_NEAR(z * u / (f * (1 + kError)) / x - 1, StretchFromDistances(kError).across, 1e-7);
}

TEST(FocalErrorFromFov, IsTheDerivativeOfTheFocalLength) {
  for (const double fov : {20.0, 50.0, 90.0, 130.0}) {
    const double f = PinholeCamera(fov, 1920, 1080).intrinsics.fx;
    const double wider = PinholeCamera(fov + 1e-4, 1920, 1080).intrinsics.fx;
    EXPECT_NEAR((wider / f - 1) / 1e-4, FocalErrorFromFov(fov, 1), 1e-5);
  }
}

}  // namespace
}  // namespace flocklift
