// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/predict/motion_filter.h"

#include <gtest/gtest.h>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

MotionFilter Start() { return MotionFilter({{100, 100}, {4, 0}, 0.2, 0, 1}); }

TEST(MotionFilterTest, DensityIntegratesToOne) {
  MotionFilter filter = Start();
  filter.Predict(StepOf(0), 0.01, 3);
  double sum = 0;
  constexpr double kStep = 0.25;
  for (double x = -100; x <= 100; x += kStep) {
    for (double y = -100; y <= 100; y += kStep) {
      const Vec2d z{filter.state().position.x + x, filter.state().position.y + y};
      sum += std::exp(-filter.NegativeLogLikelihood(z, 0.2)) * kStep * kStep;
    }
  }
  EXPECT_NEAR(sum, 1, 0.01);
}

// With equal modes it is the Kalman filter.
TEST(MotionFilterTest, GoesStraightLikeAKalmanFilter) {
  MotionFilter filter = Start();
  MotionState kalman{{100, 100}, {4, 0}, 0.2, 0, 1};
  for (int frame = 1; frame <= 20; ++frame) {
    filter.Predict(StepOf(0), 0);
    Predict(&kalman, StepOf(0), 0);
    const Vec2d z{100 + 4.2 * frame, 100 + 0.1 * frame};
    filter.Update(z, 0.2);
    Update(&kalman, z, 0.2);
    EXPECT_NEAR(filter.state().position.x, kalman.position.x, 1e-9);
    EXPECT_NEAR(filter.state().velocity.y, kalman.velocity.y, 1e-9);
    EXPECT_NEAR(filter.state().pp, kalman.pp, 1e-9);
  }
}

// A sharp turn after a long glide: the filter follows and says so.
TEST(MotionFilterTest, FollowsATurnThatOneModeLoses) {
  constexpr double kQ = 1e-4;
  MotionFilter filter = Start();
  MotionState kalman{{100, 100}, {4, 0}, 0.2, 0, 1};
  Rng rng(3);
  Vec2d p{100, 100}, v{4, 0};
  double glide_agility = 0, turn_agility = 0, filter_error = 0, kalman_error = 0;
  for (int frame = 1; frame <= 60; ++frame) {
    if (frame > 40 && frame <= 50) v = {v.x - 0.4, v.y + 0.5};
    p = {p.x + v.x, p.y + v.y};
    filter.Predict(StepOf(0), kQ);
    Predict(&kalman, StepOf(0), kQ);
    if (frame > 40) {
      filter_error = std::max(filter_error, std::hypot(filter.state().position.x - p.x,
                                                       filter.state().position.y - p.y));
      kalman_error =
          std::max(kalman_error, std::hypot(kalman.position.x - p.x, kalman.position.y - p.y));
    }
    const Vec2d z{p.x + 0.3 * rng.Normal(), p.y + 0.3 * rng.Normal()};
    filter.Update(z, 0.1);
    Update(&kalman, z, 0.1);
    if (frame == 40) glide_agility = filter.agility();
    if (frame == 47) turn_agility = filter.agility();
  }
  EXPECT_GT(kalman_error, 15);
  EXPECT_LT(filter_error, 0.5 * kalman_error);
  EXPECT_GT(turn_agility, 4 * glide_agility);
}

// Where accelerations stay alike, the agile mode is as wide as with constant velocity.
TEST(MotionFilterTest, ReachesWhatNoCurveAnnounces) {
  constexpr double kQ = 0.3, kCorrelation = 8;
  MotionFilter filter({.position = {0, 0},
                       .velocity = {2, 0},
                       .pp = 0.2,
                       .vv = 1,
                       .aa = AccelerationVariance(kQ, kCorrelation)});
  MotionState agile{{0, 0}, {2, 0}, 0.2, 0, 1}, curved = agile;
  curved.aa = 16 * AccelerationVariance(kQ, kCorrelation);
  for (int frame = 1; frame <= 30; ++frame) {
    filter.Predict(StepOf(kCorrelation), kQ);
    Predict(&agile, StepOf(0), 16 * kQ);
    Predict(&curved, StepOf(kCorrelation), 16 * kQ);
    if (frame == 30) break;
    filter.Update({2.0 * frame, 0}, 0.2);
    Update(&agile, {2.0 * frame, 0}, 0.2);
    Update(&curved, {2.0 * frame, 0}, 0.2);
  }
  EXPECT_GT(filter.widest_pp(), 0.5 * agile.pp);
  EXPECT_GT(filter.widest_pp(), 2 * curved.pp);
}

// On a circle the acceleration goes on as it is: Singer's filter sees the next place coming.
TEST(MotionFilterTest, KnowsOfACurveWhenAccelerationsStayAlike) {
  constexpr double kQ = 1, kRadius = 30, kAngle = 0.15;
  double error[2] = {0, 0};
  for (const bool is_singer : {false, true}) {
    const double correlation = is_singer ? 10 : 0;
    MotionFilter filter({.position = {kRadius, 0},
                         .velocity = {0, kRadius * kAngle},
                         .pp = 0.2,
                         .vv = 1,
                         .aa = AccelerationVariance(kQ, correlation)});
    for (int frame = 1; frame <= 60; ++frame) {
      filter.Predict(StepOf(correlation), kQ);
      const Vec2d p{kRadius * std::cos(kAngle * frame), kRadius * std::sin(kAngle * frame)};
      if (frame > 20) {
        error[is_singer] +=
            std::hypot(filter.state().position.x - p.x, filter.state().position.y - p.y) / 40;
      }
      filter.Update(p, 0.01);
    }
  }
  EXPECT_LT(error[1], 0.6 * error[0]);
}

}  // namespace
}  // namespace flocklift
