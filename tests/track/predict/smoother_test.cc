// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/predict/smoother.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

constexpr double kSpeedSd = 6;

// Measurements of a wandering point; two frames are missing.
std::vector<Measurement> Wander(double q, std::uint64_t seed) {
  std::vector<Measurement> measurements;
  Rng rng(seed);
  Vec2d p{100, 50}, v{3, -2};
  for (int frame = 1; frame <= 14; ++frame) {
    v.x += std::sqrt(q) * rng.Normal();
    v.y += std::sqrt(q) * rng.Normal();
    p.x += v.x;
    p.y += v.y;
    if (frame == 6 || frame == 7) continue;
    const double variance = frame == 10 ? 2.0 : 0.3;
    measurements.push_back({frame,
                            {p.x + 0.5 * rng.Normal(), p.y + 0.5 * rng.Normal()},
                            variance,
                            frame == 11 ? 9.0 : 1.0});
  }
  return measurements;
}

// The same problem as one weighted least squares over all states of one axis.
Eigen::VectorXd Batch(const std::vector<Measurement>& m, double q, bool x_axis,
                      Eigen::MatrixXd* covariance) {
  const int first = m.front().frame, count = m.back().frame - first + 1;
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(2 * count, 2 * count);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(2 * count);
  for (const Measurement& z : m) {
    const int k = 2 * (z.frame - first);
    information(k, k) += 1 / z.variance;
    right(k) += (x_axis ? z.position.x : z.position.y) / z.variance;
  }
  information(1, 1) += 1 / (kSpeedSd * kSpeedSd);
  Eigen::Matrix2d step;
  step << 1, 1, 0, 1;
  std::size_t next = 1;
  for (int k = 1; k < count; ++k) {
    while (m[next].frame < first + k) ++next;
    Eigen::Matrix2d noise;
    noise << 1.0 / 3, 0.5, 0.5, 1;
    const Eigen::Matrix2d weight = (q * m[next].agility * noise).inverse();
    Eigen::Matrix<double, 2, 4> jacobian;
    jacobian << -step, Eigen::Matrix2d::Identity();
    information.block<4, 4>(2 * k - 2, 2 * k - 2) += jacobian.transpose() * weight * jacobian;
  }
  *covariance = information.inverse();
  return *covariance * right;
}

TEST(SmootherTest, AgreesWithBatchLeastSquares) {
  for (const double q : {0.01, 0.5}) {
    const std::vector<Measurement> m = Wander(q, 3);
    const std::vector<MotionState> smooth = Smooth(m, q, kSpeedSd);
    ASSERT_EQ(smooth.size(), 14u);
    Eigen::MatrixXd covariance;
    const Eigen::VectorXd x = Batch(m, q, true, &covariance), y = Batch(m, q, false, &covariance);
    for (int k = 0; k < 14; ++k) {
      EXPECT_NEAR(smooth[k].position.x, x(2 * k), 1e-8) << k;
      EXPECT_NEAR(smooth[k].velocity.x, x(2 * k + 1), 1e-8) << k;
      EXPECT_NEAR(smooth[k].position.y, y(2 * k), 1e-8) << k;
      EXPECT_NEAR(smooth[k].velocity.y, y(2 * k + 1), 1e-8) << k;
      EXPECT_NEAR(smooth[k].pp, covariance(2 * k, 2 * k), 1e-8) << k;
      EXPECT_NEAR(smooth[k].pv, covariance(2 * k, 2 * k + 1), 1e-8) << k;
      EXPECT_NEAR(smooth[k].vv, covariance(2 * k + 1, 2 * k + 1), 1e-8) << k;
    }
  }
}

// The filter's last state is the batch solution, too: no information is lost on the way.
TEST(KalmanTest, AgreesWithBatchLeastSquares) {
  const std::vector<Measurement> m = Wander(0.2, 5);
  MotionState state{m[0].position, {0, 0}, m[0].variance, 0, kSpeedSd * kSpeedSd};
  for (std::size_t k = 1; k < m.size(); ++k) {
    Predict(&state, 0.2 * m[k].agility, m[k].frame - m[k - 1].frame);
    Update(&state, m[k].position, m[k].variance);
  }
  Eigen::MatrixXd covariance;
  const Eigen::VectorXd x = Batch(m, 0.2, true, &covariance);
  EXPECT_NEAR(state.position.x, x(26), 1e-8);
  EXPECT_NEAR(state.velocity.x, x(27), 1e-8);
  EXPECT_NEAR(state.pp, covariance(26, 26), 1e-8);
}

TEST(SmootherTest, OneMeasurementIsItself) {
  const std::vector<Measurement> m{{5, {10, 20}, 0.5, 1}};
  const auto smooth = Smooth(m, 0.1, 3);
  ASSERT_EQ(smooth.size(), 1u);
  EXPECT_EQ(smooth[0].position, (Vec2d{10, 20}));
}

}  // namespace
}  // namespace flocklift
