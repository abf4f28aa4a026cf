// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The linear reference flock (equations.md, section 2b), on which estimators are checked: springs
// and drag between all pairs, summed and not averaged.
//   a_i = gain * sum_j (x_j - x_i)      LinearCohesion
//   a_i = gain * sum_j (v_j - v_i)      LinearAlignment

#ifndef FLOCKLIFT_SIMULATE_FORCES_LINEAR_H_
#define FLOCKLIFT_SIMULATE_FORCES_LINEAR_H_

#include "simulate/forces/term.h"

namespace flocklift {

struct LinearCohesion {
  template <typename T>
  struct Params {
    T gain;  // [1/s^2]
  };

  template <typename T>
  static Share<T> Pair(const Params<T>& /*p*/, const Vec3<T>& dx, const Vec3<T>& /*dv*/) {
    return {dx, T(1.0)};
  }

  template <typename T>
  static Vec3<T> Finish(const Params<T>& p, const Weighted<T>& sum) {
    return p.gain * sum.value;
  }
};

struct LinearAlignment {
  template <typename T>
  struct Params {
    T gain;  // [1/s]
  };

  template <typename T>
  static Share<T> Pair(const Params<T>& /*p*/, const Vec3<T>& /*dx*/, const Vec3<T>& dv) {
    return {dv, T(1.0)};
  }

  template <typename T>
  static Vec3<T> Finish(const Params<T>& p, const Weighted<T>& sum) {
    return p.gain * sum.value;
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FORCES_LINEAR_H_
