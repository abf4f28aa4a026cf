// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The linear reference flock (equations.md, section 2b), on which estimators are checked:
//   dv_i = ( cohesion sum_j (x_j - x_i) + alignment sum_j (v_j - v_i) ) dt + sqrt(2 diffusion) dW

#ifndef FLOCKLIFT_SIMULATE_FLOCK_LINEAR_MODEL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_LINEAR_MODEL_H_

#include "simulate/core/options.h"

namespace flocklift {

template <typename T>
struct LinearParameters {
  T cohesion{0.02}, alignment{0.01}, diffusion{0.01};
};

template <typename Visitor, typename T>
void Describe(Visitor& visit, LinearParameters<T>& p) {
  visit("cohesion", p.cohesion, {}, "1/s^2", "spring between each pair");
  visit("alignment", p.alignment, {}, "1/s", "drag between each pair");
  visit("diffusion", p.diffusion, {.low = 0}, "m^2/s^3", "of the velocity, per axis");
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_LINEAR_MODEL_H_
