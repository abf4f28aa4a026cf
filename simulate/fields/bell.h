// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The repulsion of obstacles, a bell over the signed distance phi to them:
//   g = h(phi / (2 a)),  h(r) = 1                                      r < 0
//                             = 1 - 22/9 r^2 + 17/9 r^4 - 4/9 r^6      0 <= r <= 1
//                             = 0                                      r > 1
// h(0) = 1, h(1) = 0, h'(0) = h'(1) = 0, h(1/2) = 1/2. a is the diagonal of a cell, so that the
// repulsion reaches two diagonals far. B. Wyvill, C. McPheeters, G. Wyvill, "Data structure for
// soft objects", The Visual Computer 2 (1986) 227-234, as used by X. Wang, X. Jin, Z. Deng,
// L. Zhou, "Inherent noise-aware insect swarm simulation", Computer Graphics Forum 33 (2014) 51-62.

#ifndef FLOCKLIFT_SIMULATE_FIELDS_BELL_H_
#define FLOCKLIFT_SIMULATE_FIELDS_BELL_H_

#include "simulate/core/vec3.h"

namespace flocklift {

// The diagonal of a cubic cell in units of its side.
inline constexpr double kCellDiagonal = 1.7320508075688772;

template <typename T>
T Bell(const T& r) {
  const T zero(0.0), one(1.0);
  const T u = select(r < zero, zero, select(r > one, one, r));
  const T s = u * u;
  return one - s * (T(22.0) - s * (T(17.0) - T(4.0) * s)) / T(9.0);
}

// g of a signed distance [m] for the diagonal a [m].
template <typename T>
T Repulsion(const T& distance, const T& diagonal) {
  return Bell(T(distance / (T(2.0) * diagonal)));
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FIELDS_BELL_H_
