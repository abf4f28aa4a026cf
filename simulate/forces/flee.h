// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fear: a push straight away from a predator (equations.md, section 1, bonuses); summed over the
// predators, which take the part of the neighbour j.
//   a_i = -gain * w(|dx|) * dx / |dx|,   w = TaperWindow(|dx|; radius, taper)

#ifndef FLOCKLIFT_SIMULATE_FORCES_FLEE_H_
#define FLOCKLIFT_SIMULATE_FORCES_FLEE_H_

#include "simulate/forces/term.h"
#include "simulate/forces/window.h"

namespace flocklift {

struct Flee {
  template <typename T>
  struct Params {
    T gain;    // [m/s^2]
    T radius;  // [m]
    T taper;   // width of the window's edge [m]
  };

  template <typename T>
  static Share<T> Pair(const Params<T>& p, const Vec3<T>& dx, const Vec3<T>& /*dv*/) {
    const T squared = Dot(dx, dx);
    const T w = TaperWindow(squared, p.radius, p.taper);
    return {(T(-1.0) / SoftLength(squared)) * dx, w};
  }

  template <typename T>
  static Vec3<T> Finish(const Params<T>& p, const Weighted<T>& sum) {
    return p.gain * sum.value;
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FORCES_FLEE_H_
