// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One animal in the filter (flock_filter.h): what is known of its state, z = (x, v), how that
// covariance goes through a step, and what a sighting makes of it. With P predicted and noise s^2,
//   S = H P H' + s^2 I,   K = P H' S^-1,   P <- (I - K H) P (I - K H)' + K s^2 K'     (Joseph)

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_FILTER_TRACK_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_FILTER_TRACK_H_

#include <Eigen/Core>

#include "reconstruct/fit/process_model.h"
#include "reconstruct/fit/state_transition.h"
#include "simulate/core/vec3.h"

namespace flocklift::internal {

// One animal's estimate.
struct FilterTrack {
  bool active = false;
  int unseen = 0;  // frames since it was measured
  Vec3d x, v;
  Matrix6 covariance = Matrix6::Zero();
  // What the last frame used, which the next one may use again.
  bool has_transition = false, settled = false;
  OwnSlope slope;
  StateTransition transition;
  // Of this frame, in which a speed limit acts.
  bool is_limited = false;
  int until_forgotten = 0;  // frames for which its covariance is still of one that acted
  StateStep step;
  Eigen::Matrix<double, 6, 3> gain = Eigen::Matrix<double, 6, 3>::Zero();
  Eigen::Matrix3d innovation_covariance = Eigen::Matrix3d::Zero(),
                  innovation_information = Eigen::Matrix3d::Zero();
  double log_determinant = 0;
};

// The two halves of a step, on the covariance.
void Kick(FilterTrack* track);
void Drift(FilterTrack* track);

// Gain, S and the covariance after a sighting whose position noise has this variance. A track whose
// gain and S are as they were is settled: its covariance repeats itself.
void FindGain(double variance, FilterTrack* track);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_FILTER_TRACK_H_
