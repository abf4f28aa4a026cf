// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/cost_functions/path.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flocklift {
namespace {

TEST(Path, WeightsReproduceALine) {
  for (double s : {0.0, 0.2, 0.5, 1.0}) {
    const auto w = SplineWeights(s);
    EXPECT_NEAR(w[0] + w[1] + w[2] + w[3], 1, 1e-14);
    EXPECT_NEAR(-w[0] + w[2] + 2 * w[3], s, 1e-14);
  }
}

TEST(Path, SlopesAreDerivativesOfWeights) {
  for (double s : {0.1, 0.5, 0.9}) {
    const auto slopes = SplineSlopes(s);
    const auto after = SplineWeights(s + 1e-6), before = SplineWeights(s - 1e-6);
    for (int a = 0; a < 4; ++a) EXPECT_NEAR(slopes[a], (after[a] - before[a]) / 2e-6, 1e-9);
  }
}

TEST(Path, KnotsAreTheEndsOfIntervals) {
  const auto w = SplineWeights(0);
  const double c[] = {0.3, 1, 2, 0.5, 1.5, 2.2, 0.9, 1.2, 2.1};
  const PathState<double> q = StateAtKnot(c, 10.0);
  EXPECT_NEAR(q.x, w[0] * c[0] + w[1] * c[3] + w[2] * c[6], 1e-14);
  EXPECT_NEAR(q.dl, (c[8] - c[2]) / 0.2, 1e-12);
  EXPECT_NEAR(q.ddy, (c[1] - 2 * c[4] + c[7]) * 100, 1e-10);
}

// A helix in space, its rays and log depth differentiated by hand, gives back its own velocity and
// acceleration.
TEST(Path, VelocityAndAccelerationOfAHelix) {
  const double t = 0.7, h = 1e-4;
  const auto position = [](double time) {
    return Vec3d{3 * std::cos(time), 3 * std::sin(time), 20 + 2 * time};
  };
  const auto ray = [&](double time) {
    const Vec3d p = position(time);
    return Vec3d{p.x / p.z, p.y / p.z, std::log(p.z)};
  };
  const Vec3d here = ray(t), slope = (ray(t + h) - ray(t - h)) / (2 * h),
              curve = (ray(t + h) - 2.0 * here + ray(t - h)) / (h * h);
  const PathState<double> q{here.x,  here.y,  here.z,  slope.x, slope.y,
                            slope.z, curve.x, curve.y, curve.z};
  const double z = position(t).z;
  const Vec3d velocity{-3 * std::sin(t), 3 * std::cos(t), 2};
  const Vec3d acceleration{-3 * std::cos(t), -3 * std::sin(t), 0};
  EXPECT_LT(Norm(z * VelocityOverDepth(q, {}) - velocity), 1e-6);
  EXPECT_LT(Norm(z * AccelerationOverDepth(q, {}) - acceleration), 1e-5);
  // The same seen from a camera that moves: the animal's own motion is the sum.
  const CameraMotion camera{
      .moves = true, .velocity = {1, -2, 0.5}, .acceleration = {0.3, 0.2, -0.1}};
  EXPECT_LT(Norm(z * VelocityOverDepth(q, camera) - velocity - camera.velocity), 1e-6);
  EXPECT_LT(Norm(z * AccelerationOverDepth(q, camera) - acceleration - camera.acceleration), 1e-5);
}

}  // namespace
}  // namespace flocklift
