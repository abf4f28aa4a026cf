// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How an animal is held in the air, from its path: x along the velocity; in a coordinated turn the
// lift balances gravity and gives the sideways acceleration, so the body's up is what is across the
// velocity of a + g up (bank angle atan(a_side / g)).

#ifndef FLOCKLIFT_RECONSTRUCT_ORIENTATION_H_
#define FLOCKLIFT_RECONSTRUCT_ORIENTATION_H_

#include "simulate/core/rigid3.h"

namespace flocklift {

// world_from_body (x forward, y left, z up) in the axes of the arguments; `up` is a unit vector.
// An animal that stands still looks along no direction in particular, with its wings level. The
// bank is limited to 70 degrees.
Rotation3d WorldFromFlyingBody(const Vec3d& velocity, const Vec3d& acceleration, const Vec3d& up);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_ORIENTATION_H_
