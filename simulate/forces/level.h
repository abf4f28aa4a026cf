// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Level flight: birds of a flock climb and sink far less than they turn.
//   a = -gain * (0, 0, v_z)

#ifndef FLOCKLIFT_SIMULATE_FORCES_LEVEL_H_
#define FLOCKLIFT_SIMULATE_FORCES_LEVEL_H_

#include "simulate/forces/term.h"

namespace flocklift {

struct Level {
  template <typename T>
  struct Params {
    T gain;  // [1/s]
  };

  template <typename T>
  static Vec3<T> At(const Params<T>& p, const Vec3<T>& /*x*/, const Vec3<T>& v) {
    return {T(0.0), T(0.0), -p.gain * v.z};
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FORCES_LEVEL_H_
