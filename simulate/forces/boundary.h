// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Soft walls of the UCSD assignment (equations.md, section 1), per axis k:
//   a_k = gain * ( [x_k < low_k] - [x_k > high_k] ),   each step `taper` wide, centred on the wall

#ifndef FLOCKLIFT_SIMULATE_FORCES_BOUNDARY_H_
#define FLOCKLIFT_SIMULATE_FORCES_BOUNDARY_H_

#include "simulate/forces/term.h"
#include "simulate/forces/window.h"

namespace flocklift {

struct Boundary {
  template <typename T>
  struct Params {
    T gain;             // alpha_b [m/s^2]
    Vec3<T> low, high;  // where the walls stand [m]
    T taper;            // over how much of the way the push sets in [m]
  };

  template <typename T>
  static Vec3<T> At(const Params<T>& p, const Vec3<T>& x, const Vec3<T>& /*v*/) {
    const auto push = [&p](const T& at, const T& low, const T& high) -> T {
      return p.gain * (SoftStep(T(low - at), p.taper) - SoftStep(T(at - high), p.taper));
    };
    return {push(x.x, p.low.x, p.high.x), push(x.y, p.low.y, p.high.y),
            push(x.z, p.low.z, p.high.z)};
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FORCES_BOUNDARY_H_
