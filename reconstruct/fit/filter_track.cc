// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/filter_track.h"

#include <Eigen/Dense>
#include <cmath>

namespace flocklift::internal {
namespace {

using Gain = Eigen::Matrix<double, 6, 3>;
using Matrix3 = Eigen::Matrix3d;

constexpr double kSettled = 1e-12;  // relative change of a covariance that counts as none

}  // namespace

void Kick(FilterTrack* track) {
  const StateStep& step = track->step;
  track->covariance = step.kick * track->covariance * step.kick.transpose() + step.kick_noise;
}

void Drift(FilterTrack* track) {
  const Matrix6& drift = track->step.drift;
  track->covariance = drift * track->covariance * drift.transpose();
}

void FindGain(double variance, FilterTrack* track) {
  const Matrix6 predicted = track->covariance;
  const Matrix3 noise = variance * Matrix3::Identity();
  const Matrix3 s = predicted.topLeftCorner<3, 3>() + noise;
  const Eigen::LLT<Matrix3> llt(s);
  const bool known = track->unseen == 1 && track->innovation_covariance.isApprox(s, kSettled) &&
                     track->has_transition;
  track->innovation_covariance = s;
  track->innovation_information = llt.solve(Matrix3::Identity());
  track->log_determinant = 2 * std::log(llt.matrixL().toDenseMatrix().diagonal().prod());
  const Gain gain = predicted.leftCols<3>() * track->innovation_information;
  Matrix6 left = Matrix6::Identity();
  left.leftCols<3>() -= gain;
  track->settled = known && gain.isApprox(track->gain, kSettled);
  track->gain = gain;
  track->covariance = left * predicted * left.transpose() + gain * noise * gain.transpose();
}

}  // namespace flocklift::internal
