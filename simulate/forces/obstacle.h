// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Avoiding obstacles by taking away what flies into them (Bridson et al. 2007 in the form of Chen
// et al. 2019, eq. 8; equations.md, section 6):
//   u_a = u - (1 - ramp(d / L)) n (n . u)   where n . u < 0, else u
//   ramp(x) = 15/8 x - 10/8 x^3 + 3/8 x^5 on [0, 1], 0 below, 1 above
// d is the distance to the obstacle, n the direction away from it: at the wall nothing flies in any
// more, from L on nothing is changed.

#ifndef FLOCKLIFT_SIMULATE_FORCES_OBSTACLE_H_
#define FLOCKLIFT_SIMULATE_FORCES_OBSTACLE_H_

#include "simulate/core/vec3.h"

namespace flocklift {

template <typename T>
T ObstacleRamp(const T& x) {
  const T zero(0.0), one(1.0);
  const T u = select(x < zero, zero, select(x > one, one, x));
  const T squared = u * u;
  return u * (T(1.875) - squared * (T(1.25) - T(0.375) * squared));
}

struct ObstacleAvoidance {
  template <typename T>
  struct Params {
    T range;  // L, > 0 [m]
  };

  // `away` is a unit vector, or 0 where there is no obstacle.
  template <typename T>
  static Vec3<T> Turn(const Params<T>& p, const T& distance, const Vec3<T>& away,
                      const Vec3<T>& u) {
    const T outwards = Dot(away, u);
    const T inwards = select(outwards < T(0.0), outwards, T(0.0));
    return u - ((T(1.0) - ObstacleRamp(T(distance / p.range))) * inwards) * away;
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FORCES_OBSTACLE_H_
