// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The simulator of Lin's thesis (2019; equations.md, section 2): position-based, no alignment.
//   velocity = gain (w_sep s + (1 - w_sep) c) / frame_time + home (home point - x)
// is the way to the target of one frame; gain 1 and inertia 0 go all of it at once, as published.
// With inertia m in [0, 1) a frame keeps m of the velocity and takes 1 - m of the new one. Home
// points (Xu et al. 2008) are the scene's goals.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_LIN_MODEL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_LIN_MODEL_H_

#include "simulate/core/options.h"

namespace flocklift {

template <typename T>
struct LinParameters {
  T w_sep{0.8}, d_sep{4.0}, exponent{0.0};
  T gain{0.1}, inertia{0.0};
  T home{1.0};
  T s_max{15.0};
  T frame_time{1.0 / 30};
};

template <typename Visitor, typename T>
void Describe(Visitor& visit, LinParameters<T>& p) {
  visit("w_sep", p.w_sep, {.low = 0, .high = 1}, "",
        "weight of separation; cohesion has the rest (lambda_sep)");
  visit("d_sep", p.d_sep, {.low = 0}, "m", "animals up to this far push apart");
  visit("exponent", p.exponent, {.low = 0, .high = 4}, "",
        "separation falls as 1/distance^k; 0: Algorithm 1, 1: the text");
  visit("gain", p.gain, {.low = 0, .high = 1}, "",
        "share of the way to the target that is gone in a frame; 1: as published");
  visit("inertia", p.inertia, {.low = 0, .high = 0.999}, "",
        "share of the velocity that is kept over a frame; 0: as published");
  visit("home", p.home, {.low = 0}, "1/s", "homing: speed per distance to the home point (goal)");
  visit("s_max", p.s_max, {.low = 0}, "m/s", "highest speed");
  visit("frame_time", p.frame_time, {.low = 1e-9}, "s", "the frame that the rules speak of");
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_LIN_MODEL_H_
