// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/followed_flock.h"

#include <cmath>

namespace flocklift::internal {

CoupledFlock FollowedFlock::Coupled(const BatchModel& model) {
  CoupledFlock coupled(model, &birds, &shared, scale);
  coupled.forces.unknowns = forces;
  coupled.noise = noise;
  coupled.Relinearize();
  return coupled;
}

double FollowedFlock::OfNoise() const {
  double accelerations = 0;
  for (const Bird& bird : birds) accelerations += 3.0 * bird.knots;
  return accelerations * std::log(noise.sd);
}

void FollowedFlock::Take(const CoupledFlock& coupled) {
  forces = coupled.forces.unknowns;
  noise = coupled.noise;
  scale = coupled.scale();
  improbable = coupled.Cost() + OfNoise();
}

CoupledFlock FollowedFlock::Settle(const BatchModel& model, int iterations, double hopeless) {
  CoupledFlock coupled = Coupled(model);
  coupled.Minimize(iterations, {.hopeless = hopeless - OfNoise()});
  Take(coupled);
  return coupled;
}

}  // namespace flocklift::internal
