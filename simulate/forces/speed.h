// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Speed: the clamp of the UCSD assignment (equations.md, section 1), and the relaxation of an
// animal's speed to its own cruising speed.
//   Limit(v) = v clamp(|v|, min, max) / |v|, 0 stays 0;   the corners are rounded over `taper`
//   CruiseSpeed: a = gain * (speed - |v|) v / |v|

#ifndef FLOCKLIFT_SIMULATE_FORCES_SPEED_H_
#define FLOCKLIFT_SIMULATE_FORCES_SPEED_H_

#include "simulate/forces/term.h"
#include "simulate/forces/window.h"

namespace flocklift {

struct SpeedLimit {
  template <typename T>
  struct Params {
    T min, max;  // s_min, s_max [m/s]
    T taper;     // width of the rounded corners [m/s]
  };

  template <typename T>
  static Vec3<T> Limit(const Params<T>& p, const Vec3<T>& v) {
    const T squared = Dot(v, v);
    const T speed = SoftLength(squared);
    const T wanted = SoftMin(SoftMax(speed, p.min, p.taper), p.max, p.taper);
    return select(squared > T(0.0), T(wanted / speed), T(1.0)) * v;
  }
};

struct CruiseSpeed {
  template <typename T>
  struct Params {
    T gain;   // [1/s]
    T speed;  // the animal's own [m/s]
  };

  template <typename T>
  static Vec3<T> At(const Params<T>& p, const Vec3<T>& /*x*/, const Vec3<T>& v) {
    const T speed = SoftLength(Dot(v, v));
    return (p.gain * (p.speed - speed) / speed) * v;
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FORCES_SPEED_H_
