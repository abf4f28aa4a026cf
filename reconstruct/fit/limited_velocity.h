// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a speed limit makes of a velocity that is known but for Gaussian noise. With u the direction
// of its mean m u, sigma^2 its variance along u and T its covariance across, the speed is
//   s ~ N(m', sigma^2),   m' = m + tr T / (2 m)
// to second order, and s' = clamp(s, low, high) has closed moments; by Stein's lemma Cov(s', s) =
// sigma^2 P(low < s < high). Statistical linearisation (Gelb, "Applied optimal estimation", 1974,
// chapter 6) makes of it
//   v' = m / m' E[s'] u + C (v - m u) + e,   C = P(low < s < high) u u' + E[s'] / m' (I - u u'),
// e along u and independent of v. An animal held at its lowest speed is on average faster than it,
// by what the noise adds; and no moment jumps when the mean crosses a limit.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_LIMITED_VELOCITY_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_LIMITED_VELOCITY_H_

#include <Eigen/Core>

#include "reconstruct/fit/process_model.h"

namespace flocklift {

struct LimitedVelocity {
  Eigen::Vector3d mean;
  Eigen::Matrix3d kept;   // C: what is let through of a deviation
  Eigen::Matrix3d noise;  // Cov e
  bool acts = false;      // does a limit change more than nearly nothing?
};

// Can a limit act, but for less than one in 10^8, on a velocity this fast, of this sd at most?
bool IsNearLimit(const SpeedRange& range, double speed, double sd);

// `mean` is not 0; a range whose low end is 0 has no lowest speed. The variance of v' along u is at
// least `least`, or sigma^2, if that is less.
LimitedVelocity LimitVelocity(const SpeedRange& range, const Eigen::Vector3d& mean,
                              const Eigen::Matrix3d& covariance, double least);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_LIMITED_VELOCITY_H_
