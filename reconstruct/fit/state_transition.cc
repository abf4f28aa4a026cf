// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/state_transition.h"

namespace flocklift {
namespace {

using Matrix3 = Eigen::Matrix3d;

Matrix3 AsMatrix(const std::array<double, 9>& m) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(m.data());
}

}  // namespace

StateStep MakeStateStep(double dt, int substeps, double q, const Rounding& rounding,
                        const OwnSlope& slope) {
  const double h = dt / StepsAFrame(substeps);
  const Matrix3 one = Matrix3::Identity(), dx = AsMatrix(slope.position),
                dv = AsMatrix(slope.velocity);
  StateStep step;
  if (substeps > 0) {
    step.kick.bottomRows<3>() << h * dx, one + h * dv;
    step.kick_noise.bottomRightCorner<3, 3>() = q * h * one;
    step.drift.topRightCorner<3, 3>() = h * one;
  } else {
    Matrix6 rate;
    rate << Matrix3::Zero(), one, dx, dv;
    step.kick += h * rate + 0.5 * h * h * rate * rate;
    step.kick_noise << h * h / 3 * one, h / 2 * one, h / 2 * one, one;
    step.kick_noise *= q * h;
  }
  step.kick_noise.topLeftCorner<3, 3>() += rounding.position * one;
  step.kick_noise.bottomRightCorner<3, 3>() += rounding.velocity * one;
  return step;
}

StateTransition TransitionOver(const StateStep& step, int steps) {
  const Matrix6 deviation = step.drift * step.kick;
  const Matrix6 noise = step.drift * step.kick_noise * step.drift.transpose();
  StateTransition transition;
  for (int k = 0; k < steps; ++k) {
    transition.deviation = deviation * transition.deviation;
    transition.noise = deviation * transition.noise * deviation.transpose() + noise;
  }
  return transition;
}

}  // namespace flocklift
