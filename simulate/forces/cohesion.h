// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cohesion of the UCSD assignment (equations.md, section 1): towards the mean position of those
// within sight.
//   a_i = gain * mean_j( w_j (x_j - x_i) ),   w_j = TaperWindow(|x_j - x_i|; radius, taper)

#ifndef FLOCKLIFT_SIMULATE_FORCES_COHESION_H_
#define FLOCKLIFT_SIMULATE_FORCES_COHESION_H_

#include "simulate/forces/term.h"
#include "simulate/forces/window.h"

namespace flocklift {

struct Cohesion {
  template <typename T, typename Taper = T>
  struct Params {
    T gain;       // alpha_c [1/s^2]
    T radius;     // d_v [m]
    Taper taper;  // width of the window's edge [m], or HardEdge
  };

  template <typename T, typename Taper>
  static Share<T> Pair(const Params<T, Taper>& p, const Vec3<T>& dx, const Vec3<T>& /*dv*/) {
    return {dx, TaperWindow(Dot(dx, dx), p.radius, p.taper)};
  }

  template <typename T, typename Taper>
  static Vec3<T> Finish(const Params<T, Taper>& p, const Weighted<T>& sum) {
    return p.gain * Mean(sum);
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FORCES_COHESION_H_
