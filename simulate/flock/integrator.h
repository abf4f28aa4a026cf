// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One step of time, the same for the simulator and the inversion: semi-implicit Euler, the speed
// limit before the move (equations.md, section 1).
//   v' = Limit(v + a dt),   x' = x + v' dt

#ifndef FLOCKLIFT_SIMULATE_FLOCK_INTEGRATOR_H_
#define FLOCKLIFT_SIMULATE_FLOCK_INTEGRATOR_H_

#include "simulate/forces/speed.h"

namespace flocklift {

template <typename T>
void Advance(const Vec3<T>& acceleration, const T& dt, const SpeedLimit::Params<T>& limit,
             Vec3<T>* position, Vec3<T>* velocity) {
  *velocity = SpeedLimit::Limit(limit, *velocity + dt * acceleration);
  *position += dt * *velocity;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_INTEGRATOR_H_
