// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A flock that flies by a model and is pulled to given paths at once, the trade-off of Chen et al.
// 2019 between internal and external force:
//   a_i = alpha (model) + (1 - alpha) ( w^2 (p_i - x_i) + 2 w (q_i - v_i) ),   w = 1 / pull_time
// with p_i, q_i position and velocity on the path: a critically damped spring. An animal without a
// path at a time flies by the model alone. The model's noise is left out, and of goals only the
// first counts, at rest. The terms and the step are the simulator's (flock_terms.h, integrator.h),
// in double precision. Metres, seconds.

#ifndef FLOCKLIFT_RECONSTRUCT_REPLAY_GUIDED_FLIGHT_H_
#define FLOCKLIFT_RECONSTRUCT_REPLAY_GUIDED_FLIGHT_H_

#include <optional>
#include <vector>

#include "reconstruct/fit/flock_terms.h"
#include "simulate/core/parameters.h"

namespace flocklift {

struct PathPoint {
  Vec3d position, velocity;
};

class GuidedFlight {
 public:
  // `cruising_speed`: each animal's own [m/s]; `around`: what the terms of a scene feel. Throws
  // InputError for a model without accelerations.
  GuidedFlight(const Parameters& parameters, double alpha, double pull_time,
               std::vector<Vec3d> position, std::vector<Vec3d> velocity,
               std::vector<double> cruising_speed, const TermSurroundings& around = {});

  // `paths`: one per animal, at the start of the step.
  void Step(const std::vector<std::optional<PathPoint>>& paths, double dt);

  const std::vector<Vec3d>& position() const { return position_; }
  const std::vector<Vec3d>& velocity() const { return velocity_; }

 private:
  FlockTerms terms_;
  double alpha_, pull_time_, cruise_;
  std::vector<Vec3d> position_, velocity_;
  std::vector<double> cruising_speed_;
  std::vector<Vec3d> accelerations_;  // n x 2: the model's, and the direction of c_i
};

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_REPLAY_GUIDED_FLIGHT_H_
