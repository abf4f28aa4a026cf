// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The motion of one animal that now glides and now turns: an interacting multiple model estimator
// over the filters of kalman.h, whose modes (calm, usual, agile) differ in process noise,
// q_m = factor_m^2 q, and in the model: the agile mode has constant velocity, the others Singer's
// model where that is likelier (motion_noise.h). So a curve is seen coming, and a start that no
// curve announces stays within the agile mode's reach. Before each prediction the modes mix (mode n
// turns into m with probability T_nm),
//   c_m = sum_n T_nm w_n,   x_m <- sum_n (T_nm w_n / c_m) x_n   (moment matched),
// and a measurement reweighs them by their likelihoods, w_m ~ c_m N(z; x_m, P_m + r).
// Blom, Bar-Shalom, IEEE Trans. Automatic Control 33, 1988.

#ifndef FLOCKLIFT_TRACK_PREDICT_MOTION_FILTER_H_
#define FLOCKLIFT_TRACK_PREDICT_MOTION_FILTER_H_

#include <array>

#include "track/predict/kalman.h"

namespace flocklift {

class MotionFilter {
 public:
  static constexpr int kModes = 3;
  static constexpr std::array<double, kModes> kFactors{0.25, 1, 4};
  static constexpr double kStay = 0.95;  // T_mm; the rest is spread evenly

  MotionFilter() = default;
  // `start` is that of the mode whose factor is 1.
  explicit MotionFilter(const MotionState& start);

  // `step` is that of one frame in the calm and the usual mode.
  void Predict(const MotionStep& step, double q, int frames = 1);
  void Update(const Vec2d& z, double r);

  // -ln of the density of a measurement at z [1/px^2].
  double NegativeLogLikelihood(const Vec2d& z, double r) const;

  // Mean and covariance over the modes.
  const MotionState& state() const { return mean_; }
  double widest_pp() const { return modes_[kModes - 1].pp; }  // of the most agile mode [px^2]
  // Expected factor_m^2: what to multiply q by.
  double agility() const;

 private:
  void Mix();

  std::array<MotionState, kModes> modes_{};
  std::array<double, kModes> weights_{0.2, 0.6, 0.2};
  MotionState mean_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_PREDICT_MOTION_FILTER_H_
