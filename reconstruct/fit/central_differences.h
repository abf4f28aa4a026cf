// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Plain central differences, which nobody should fit to:
//   y = (x_{k+1} - 2 x_k + x_{k-1}) / dt^2,  the terms at x_k and v_k = (x_{k+1} - x_{k-1}) / (2
//   dt)
// Of a velocity that diffuses, sum y v telescopes to the ends of the track: what damps velocities
// comes out as nothing. Of the reference flock (equations.md 2b) 98 % of cohesion and 94 % of
// alignment are missed.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_CENTRAL_DIFFERENCES_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_CENTRAL_DIFFERENCES_H_

#include <span>

#include "reconstruct/fit/motion_rows.h"

namespace flocklift {

// Rows of the middle frames asked for (increasing); Z and Z' of the same states as X.
MotionRows CentralDifferenceRows(const FlockTerms& terms, const ObservedFlock& flock,
                                 std::span<const int> middles);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_CENTRAL_DIFFERENCES_H_
