// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A way around obstacles along their potential d, the distance to them (equations.md, section 7):
//   V_oa = w V + (1 - w) D speed0,   w = clamp(d / k_a, 0, 1)
//   D = normalise(V - g (g . V)),    g = grad d / |grad d|
// D is the part of the wanted velocity V along the surface; any direction there when V goes
// straight at it.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_OBSTACLE_AVOIDANCE_H_
#define FLOCKLIFT_SIMULATE_FLOCK_OBSTACLE_AVOIDANCE_H_

#include <algorithm>
#include <cmath>

#include "simulate/core/vec3.h"

namespace flocklift {

// A unit vector across the unit vector g.
inline Vec3d AnyAcross(const Vec3d& g) {
  const Vec3d a{std::abs(g.x), std::abs(g.y), std::abs(g.z)};
  const Vec3d axis = a.x <= a.y && a.x <= a.z ? Vec3d{1, 0, 0}
                     : a.y <= a.z             ? Vec3d{0, 1, 0}
                                              : Vec3d{0, 0, 1};
  return Normalized(Cross(g, axis));
}

// V_oa [m/s]. `distance` [m]; `outwards` is g; `range` is k_a > 0 [m].
inline Vec3d AvoidObstacle(const Vec3d& wanted, double distance, const Vec3d& outwards,
                           double range, double speed0) {
  const double w = std::clamp(distance / range, 0.0, 1.0);
  const Vec3d along = wanted - outwards * Dot(outwards, wanted);
  const bool straight = Norm(along) <= 1e-6 * Norm(wanted);
  const Vec3d direction = straight ? AnyAcross(outwards) : Normalized(along);
  return w * wanted + (1 - w) * speed0 * direction;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_OBSTACLE_AVOIDANCE_H_
