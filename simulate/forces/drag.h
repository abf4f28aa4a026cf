// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Viscous drag, which Chen et al. 2019 (section 6) offer instead of a highest speed.
//   a = -gain (v - wind)

#ifndef FLOCKLIFT_SIMULATE_FORCES_DRAG_H_
#define FLOCKLIFT_SIMULATE_FORCES_DRAG_H_

#include "simulate/forces/term.h"

namespace flocklift {

struct Drag {
  template <typename T>
  struct Params {
    T gain;        // [1/s]
    Vec3<T> wind;  // velocity of the air [m/s]
  };

  template <typename T>
  static Vec3<T> At(const Params<T>& p, const Vec3<T>& /*x*/, const Vec3<T>& v) {
    return p.gain * (p.wind - v);
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FORCES_DRAG_H_
