// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Pull to a point, as a spring: the user's click of the UCSD assignment (equations.md, section 1),
// and the homing that Lin 2019 (section 2) borrows from Xu et al. 2008.
//   a = gain (target - x) / sqrt(1 + |target - x|^2 / range^2)
// so gain * distance near by and never more than gain * range far away.

#ifndef FLOCKLIFT_SIMULATE_FORCES_ATTRACTION_H_
#define FLOCKLIFT_SIMULATE_FORCES_ATTRACTION_H_

#include <cmath>

#include "simulate/forces/term.h"

namespace flocklift {

struct Attraction {
  template <typename T>
  struct Params {
    T gain;          // [1/s^2]
    Vec3<T> target;  // [m]
    T range;         // where the spring gives way, > 0 [m]
  };

  template <typename T>
  static Vec3<T> At(const Params<T>& p, const Vec3<T>& x, const Vec3<T>& /*v*/) {
    using std::sqrt;
    const Vec3<T> offset = p.target - x;
    return (p.gain / sqrt(T(1.0) + Dot(offset, offset) / (p.range * p.range))) * offset;
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FORCES_ATTRACTION_H_
