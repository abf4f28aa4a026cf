// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The model that is only the sum of a scene's own list of force terms ([[species.force]]), with a
// speed limit: a = sum of the terms, then semi-implicit Euler (simulate/flock/integrator.h).

#ifndef FLOCKLIFT_SIMULATE_FLOCK_FORCES_MODEL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_FORCES_MODEL_H_

#include "simulate/core/options.h"

namespace flocklift {

struct ForcesParameters {
  double s_min = 0, s_max = 20;
};

template <typename Visitor>
void Describe(Visitor& visit, ForcesParameters& p) {
  visit("s_min", p.s_min, {.low = 0}, "m/s", "lowest speed");
  visit("s_max", p.s_max, {.low = 0}, "m/s", "highest speed");
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_FORCES_MODEL_H_
