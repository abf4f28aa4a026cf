// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/limited_velocity.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "simulate/core/rng.h"
#include "simulate/forces/speed.h"

namespace flocklift {
namespace {

using Matrix3 = Eigen::Matrix3d;
using Vector3 = Eigen::Vector3d;

// Moments of the simulator's own limit over random velocities.
struct Drawn {
  Vector3 mean = Vector3::Zero();
  Matrix3 covariance = Matrix3::Zero(), shared = Matrix3::Zero();  // of v', and of v' with v
};

Drawn Draw(const SpeedRange& range, const Vector3& mean, const Matrix3& covariance, int count) {
  const Matrix3 root = Eigen::LLT<Matrix3>(covariance).matrixL();
  Drawn drawn;
  Matrix3 squares = Matrix3::Zero();
  Rng rng(5);
  for (int k = 0; k < count; ++k) {
    const Vector3 off = root * Vector3(rng.Normal(), rng.Normal(), rng.Normal());
    const Vector3 v = mean + off;
    const Vec3d w = SpeedLimit::Limit(SpeedLimit::Params<double>{range.low, range.high, 0.0},
                                      Vec3d{v.x(), v.y(), v.z()});
    const Vector3 moved = Vector3(w.x, w.y, w.z) - mean;
    drawn.mean += moved / count;
    squares += moved * moved.transpose() / count;
    drawn.shared += moved * off.transpose() / count;
  }
  drawn.covariance = squares - drawn.mean * drawn.mean.transpose();
  drawn.mean += mean;
  return drawn;
}

TEST(LimitedVelocity, ItsMomentsAreThoseOfTheLimitOnRandomVelocities) {
  Matrix3 covariance;
  covariance << 1.0, 0.3, -0.2, 0.3, 0.8, 0.1, -0.2, 0.1, 1.3;
  covariance *= 4e-4;  // sd of 0.02 m/s
  constexpr int kCount = 400000;
  const double error = 5 * 0.02 / std::sqrt(kCount);
  const Vector3 direction = Vector3(2, -1, 2) / 3;
  for (const double speed : {2.94, 2.99, 3.0, 3.02, 3.05, 3.97, 4.01}) {
    const SpeedRange range{3, 4};
    const Vector3 mean = speed * direction;
    const Drawn drawn = Draw(range, mean, covariance, kCount);
    const LimitedVelocity limited = LimitVelocity(range, mean, covariance, 0);
    EXPECT_LT((limited.mean - drawn.mean).norm(), error) << speed;
    const double square = error * 0.02 * std::sqrt(2.0);
    EXPECT_LT((limited.kept * covariance - drawn.shared).norm(), square) << speed;
    const Matrix3 after = limited.kept * covariance * limited.kept.transpose() + limited.noise;
    EXPECT_LT((after - drawn.covariance).norm(), square) << speed;
  }
}

// Of an uncertain direction too: the mean of a turned velocity is shorter.
TEST(LimitedVelocity, AHeldAnimalThatTurnsIsSlowerOnAverage) {
  const Matrix3 covariance = 0.09 * Matrix3::Identity();
  const SpeedRange range{6, 14};
  const Vector3 mean(0, 5, 0);  // well below: its speed is 6
  const Drawn drawn = Draw(range, mean, covariance, 100000);
  const LimitedVelocity limited = LimitVelocity(range, mean, covariance, 0);
  EXPECT_LT(drawn.mean.y(), 5.985);
  EXPECT_NEAR(limited.mean.y(), drawn.mean.y(), 0.002);
}

TEST(LimitedVelocity, FarFromALimitNothingHappens) {
  const Matrix3 covariance = 1e-4 * Matrix3::Identity();
  const Vector3 mean(0, 3.5, 0);
  EXPECT_FALSE(IsNearLimit({3, 4}, 3.5, 0.01));
  EXPECT_TRUE(IsNearLimit({3, 4}, 3.05, 0.01));
  EXPECT_TRUE(IsNearLimit({3, 4}, 3.95, 0.01));
  EXPECT_FALSE(IsNearLimit({0, 4}, 0.01, 0.01));  // no lowest speed
  const LimitedVelocity limited = LimitVelocity({3, 4}, mean, covariance, 1e-4);
  EXPECT_LT((limited.mean - mean).norm(), 1e-9);
  EXPECT_LT((limited.kept - Matrix3::Identity()).norm(), 1e-4);
  EXPECT_LT(limited.noise.norm(), 1e-12);
  EXPECT_FALSE(limited.acts);
}

TEST(LimitedVelocity, AHeldSpeedKeepsTheLeastVariance) {
  const Matrix3 covariance = 1e-4 * Matrix3::Identity();
  const Vector3 mean(0, 2.5, 0);  // 50 sd below
  const LimitedVelocity held = LimitVelocity({3, 4}, mean, covariance, 1e-5);
  EXPECT_TRUE(held.acts);
  EXPECT_NEAR(held.mean.y(), 3, 1e-4);
  EXPECT_NEAR(held.noise(1, 1), 1e-5, 1e-12);
  EXPECT_NEAR(held.kept(0, 0), 1.2, 1e-3);  // a turn is of a faster velocity
  EXPECT_NEAR(held.kept(1, 1), 0, 1e-12);
  // ... but no more than there was.
  EXPECT_NEAR(LimitVelocity({3, 4}, mean, covariance, 1e-3).noise(1, 1), 1e-4, 1e-12);
}

}  // namespace
}  // namespace flocklift
