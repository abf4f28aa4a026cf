// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the model does not explain, u, lasts: gusts, moods, a noise with a correlation time. Past
// velocities have felt it already, so even instruments from the past would correlate with it. With
// u_k = rho u_{k-s} + e_k, rho = exp(-s dt / noise time), the differences
//   y_k - rho y_{k-s} = sum_p theta_p (X_kp - rho X_{k-s,p}) + c (n_k - rho n_{k-s}) + e_k
// leave an e_k that is new since frame k - s - m - 1, and Z'_k - rho Z_{k-s} is an instrument.
// theta and rho are solved together by Gauss-Newton steps, each a regression (lagged_regression.h)
// of e on these and on u_{k-s}, whose instrument is u_{k-s-2m-3}. s = m; rho = 0 uses y_k, Z_k.
//
// The animals' own c = mean + delta_i: the mean is one more unknown, delta_i stays in e (a share 1
// - rho of it), and what would correlate with it, the instruments' mean along n over the animal's
// *earlier* frames, is taken off them. Demeaning over all frames would bias short tracks (Nickell
// 1981); this asks that the animals be in their steady state (Blundell and Bond 1998).
//
// With frame effects, each frame's mean over the animals is taken off everything: whatever pushes
// all animals of a frame alike, such as the motion of a point that attracts them, drops out.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_WHITENED_ROWS_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_WHITENED_ROWS_H_

#include <functional>
#include <vector>

#include "reconstruct/fit/lagged_regression.h"
#include "reconstruct/fit/motion_rows.h"

namespace flocklift {

struct WhiteningOptions {
  bool lagged = true;          // false: plain least squares of y on X, biased
  bool memory = true;          // may u last?
  bool frame_effects = false;  // then the mean c counts as 0: it could not be told apart
  bool own_speed = false;      // take out the c of each animal
  int stride = 1;              // uses the frames that it divides
  double depth_variance = 0;   // variance of e along the line of sight per variance of depth,
                               // relative to its variance across [1/m^2]
  // Direction from the eye to a position in a frame; absent: no weights.
  std::function<Vec3d(int frame, const Vec3d& position)> sight;
};

// Is the mean of c an unknown?
inline bool HasMeanOwn(const WhiteningOptions& options) {
  return options.own_speed && !options.frame_effects;
}

// Frames before the middle one that a row of a given rho needs rows of.
std::vector<int> FramesBefore(int window, bool with_rho);

// The regression for a step from (theta, rho): response e, three equations a row (along the line of
// sight first); features of theta, which ends with the mean c when HasMeanOwn, one more for rho
// when `with_rho`. `depth_sd`, if not null, takes the sd of depth of each equation, 0 across the
// line of sight [m].
RegressionRows WhitenRows(const WhiteningOptions& options, const MotionRows& rows,
                          const std::vector<double>& theta, double rho, bool with_rho,
                          std::vector<double>* depth_sd = nullptr);

// u_k = y_k - X_k theta, theta without c; each animal's c taken out by its rows when own_speed.
std::vector<Vec3d> Unexplained(const MotionRows& rows, const std::vector<double>& theta,
                               bool own_speed);

// Takes each frame's mean off.
void RemoveFrameMeans(const MotionRows& rows, std::vector<Vec3d>* u);

// Correlation of the same animal's u at frames k and k - lag, and how many such pairs there are.
struct LagCorrelation {
  double value = 0;       // sum u_k . u_{k-lag} / sum |u_k|^2
  double covariance = 0;  // per component [m^2/s^4]
  std::int64_t pairs = 0;
};
LagCorrelation CorrelationAtLag(const MotionRows& rows, const std::vector<Vec3d>& u, int lag);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_WHITENED_ROWS_H_
