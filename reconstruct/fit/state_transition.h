// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How one animal's deviation from its mean state, z = (x, v), and its covariance go on, the others
// held. A step of the engine is a kick and a drift, with white acceleration noise of q a second,
//   v += h (Ax dx + Av dv) + N(0, q h),   x += h v      (semi-implicit Euler, integrator.h)
// and a speed limit, where there is one, acts in between; in continuous time a step is the second
// order of the exponential with exactly integrated noise, all of it in the kick.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_STATE_TRANSITION_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_STATE_TRANSITION_H_

#include <Eigen/Core>

#include "reconstruct/fit/filter_input.h"
#include "reconstruct/fit/process_model.h"

namespace flocklift {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

inline constexpr int kContinuousSteps = 2;  // a frame, when time is continuous

inline int StepsAFrame(int substeps) { return substeps > 0 ? substeps : kContinuousSteps; }

struct StateStep {
  Matrix6 kick = Matrix6::Identity(), kick_noise = Matrix6::Zero(), drift = Matrix6::Identity();
};

// `dt` of a frame, `substeps` of the engine a frame; 0: continuous time. Every step rounds, too.
StateStep MakeStateStep(double dt, int substeps, double q, const Rounding& rounding,
                        const OwnSlope& slope);

// Over a whole frame, no limit in the way.
struct StateTransition {
  Matrix6 deviation = Matrix6::Identity();
  Matrix6 noise = Matrix6::Zero();
};

StateTransition TransitionOver(const StateStep& step, int steps);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_STATE_TRANSITION_H_
