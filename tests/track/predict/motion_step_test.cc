// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/predict/motion_step.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "track/predict/kalman.h"

namespace flocklift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d TransitionOf(const MotionStep& s) {
  return Matrix3d{{1, s.frames, s.f_pa}, {0, 1, s.f_va}, {0, 0, s.f_aa}};
}

Matrix3d NoiseOf(const MotionStep& s) {
  return Matrix3d{{s.q_pp, s.q_pv, s.q_pa}, {s.q_pv, s.q_vv, s.q_va}, {s.q_pa, s.q_va, s.q_aa}};
}

// dF/dt = A F and dQ/dt = A Q + Q A' + B, in small steps of Runge and Kutta's.
void Integrate(double tau, double frames, Matrix3d* f, Matrix3d* q) {
  constexpr int kSteps = 2000;
  const Matrix3d a{{0, 1, 0}, {0, 0, 1}, {0, 0, -1 / tau}};
  Matrix3d b = Matrix3d::Zero();
  b(2, 2) = 1 / (tau * tau);
  const double h = frames / kSteps;
  const auto transition_rate = [&](const Matrix3d& x) -> Matrix3d { return a * x; };
  const auto noise_rate = [&](const Matrix3d& x) -> Matrix3d {
    return a * x + x * a.transpose() + b;
  };
  const auto step = [h](const auto& rate, Matrix3d* x) {
    const Matrix3d k1 = rate(*x), k2 = rate(*x + 0.5 * h * k1), k3 = rate(*x + 0.5 * h * k2),
                   k4 = rate(*x + h * k3);
    *x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  };
  *f = Matrix3d::Identity();
  *q = Matrix3d::Zero();
  for (int k = 0; k < kSteps; ++k) {
    step(transition_rate, f);
    step(noise_rate, q);
  }
}

TEST(MotionStepTest, SingersMatricesAreThoseOfTheIntegratedEquations) {
  for (const double tau : {0.5, 2.0, 8.0, 16.0}) {
    for (const double frames : {1.0, 2.5, 45.0}) {
      const MotionStep step = StepOf(tau, frames);
      Matrix3d f, q;
      Integrate(tau, frames, &f, &q);
      const Matrix3d own_f = TransitionOf(step), own_q = NoiseOf(step);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          EXPECT_NEAR(own_f(i, j), f(i, j), 1e-7 * (1 + std::abs(f(i, j)))) << tau << i << j;
          EXPECT_NEAR(own_q(i, j), q(i, j), 1e-6 * std::abs(q(i, j)) + 1e-12) << tau << i << j;
        }
      }
    }
  }
}

TEST(MotionStepTest, TwoStepsAreOne) {
  for (const double tau : {0.0, 3.0}) {
    const MotionStep one = StepOf(tau, 1), two = StepOf(tau, 2), three = StepOf(tau, 3);
    const Matrix3d f = TransitionOf(two) * TransitionOf(one);
    const Matrix3d q =
        TransitionOf(two) * NoiseOf(one) * TransitionOf(two).transpose() + NoiseOf(two);
    EXPECT_LT((f - TransitionOf(three)).cwiseAbs().maxCoeff(), 1e-12) << tau;
    EXPECT_LT((q - NoiseOf(three)).cwiseAbs().maxCoeff(), 1e-11) << tau;
  }
}

// t = 2, tau = 0: 8/3, 2, 2.
TEST(MotionStepTest, ConstantVelocityByHand) {
  const MotionStep step = StepOf(0, 2);
  EXPECT_DOUBLE_EQ(step.q_pp, 8.0 / 3);
  EXPECT_DOUBLE_EQ(step.q_pv, 2);
  EXPECT_DOUBLE_EQ(step.q_vv, 2);
  EXPECT_EQ(step.f_pa, 0);
  EXPECT_EQ(step.f_va, 0);
  EXPECT_EQ(step.q_aa, 0);
}

TEST(MotionStepTest, AShortMemoryIsConstantVelocity) {
  const MotionStep white = StepOf(0, 10), brief = StepOf(1e-3, 10);
  EXPECT_NEAR(brief.q_pp, white.q_pp, 1e-3 * white.q_pp);
  EXPECT_NEAR(brief.q_pv, white.q_pv, 1e-3 * white.q_pv);
  EXPECT_NEAR(brief.q_vv, white.q_vv, 1e-3 * white.q_vv);
}

TEST(MotionStepTest, TheAccelerationsVarianceStays) {
  constexpr double kQ = 0.7, kTau = 5;
  MotionState state{.position = {}, .velocity = {}, .aa = AccelerationVariance(kQ, kTau)};
  for (int frame = 0; frame < 30; ++frame) Predict(&state, StepOf(kTau), kQ);
  EXPECT_NEAR(state.aa, kQ / (2 * kTau), 1e-12);
  EXPECT_EQ(AccelerationVariance(kQ, 0), 0);
}

// The filter's one covariance for both axes against matrices.
TEST(KalmanTest, PredictsAndUpdatesLikeMatrices) {
  for (const double tau : {0.0, 4.0}) {
    const MotionStep step = StepOf(tau, 2);
    MotionState state{.position = {3, 1},
                      .velocity = {2, -1},
                      .pp = 0.5,
                      .pv = 0.1,
                      .vv = 4,
                      .acceleration = {0.5, 0.2},
                      .pa = 0.02,
                      .va = 0.1,
                      .aa = 0.3};
    if (tau == 0) state.acceleration = {}, state.pa = state.va = state.aa = 0;
    Vector3d x{state.position.x, state.velocity.x, state.acceleration.x};
    Matrix3d p{{state.pp, state.pv, state.pa},
               {state.pv, state.vv, state.va},
               {state.pa, state.va, state.aa}};
    constexpr double kQ = 0.3, kR = 0.4, kZ = 9;
    const Matrix3d f = TransitionOf(step);
    x = f * x;
    p = f * p * f.transpose() + kQ * NoiseOf(step);
    const Vector3d gain = p.col(0) / (p(0, 0) + kR);
    x += gain * (kZ - x(0));
    p -= gain * p.row(0).eval();
    Predict(&state, step, kQ);
    Update(&state, {kZ, 0}, kR);
    EXPECT_NEAR(state.position.x, x(0), 1e-12);
    EXPECT_NEAR(state.velocity.x, x(1), 1e-12);
    EXPECT_NEAR(state.acceleration.x, x(2), 1e-12);
    EXPECT_NEAR(state.pp, p(0, 0), 1e-12);
    EXPECT_NEAR(state.pv, p(0, 1), 1e-12);
    EXPECT_NEAR(state.vv, p(1, 1), 1e-12);
    EXPECT_NEAR(state.pa, p(0, 2), 1e-12);
    EXPECT_NEAR(state.va, p(1, 2), 1e-12);
    EXPECT_NEAR(state.aa, p(2, 2), 1e-12);
  }
}

}  // namespace
}  // namespace flocklift
