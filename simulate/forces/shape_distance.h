// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Distance force of Chen et al. 2019, eq. 6 (equations.md, section 6): towards an animal's own
// sample of the shape, fading as it arrives.
//   a = gain f(min(d/D, 1)) (s - x) / d,   d = |s - x|,   f(t) = 4 (t - 1/2)^3 + 1/2
// f(0) = 0, f(1/2) = 1/2, f(1) = 1, rising; farther than D the pull is constant.

#ifndef FLOCKLIFT_SIMULATE_FORCES_SHAPE_DISTANCE_H_
#define FLOCKLIFT_SIMULATE_FORCES_SHAPE_DISTANCE_H_

#include "simulate/forces/term.h"
#include "simulate/forces/window.h"

namespace flocklift {

struct ShapeDistance {
  template <typename T>
  struct Params {
    T gain;          // omega_dis [m/s^2]
    T range;         // D, > 0 [m]
    Vec3<T> target;  // the sample s [m]
  };

  // f of d/D.
  template <typename T>
  static T Profile(const T& share) {
    const T t = select(share < T(1.0), share, T(1.0)) - T(0.5);
    return T(4.0) * t * t * t + T(0.5);
  }

  template <typename T>
  static Vec3<T> At(const Params<T>& p, const Vec3<T>& x, const Vec3<T>& /*v*/) {
    const Vec3<T> offset = p.target - x;
    const T distance = SoftLength(Dot(offset, offset));
    return (p.gain * Profile(T(distance / p.range)) / distance) * offset;
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FORCES_SHAPE_DISTANCE_H_
