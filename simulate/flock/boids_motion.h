// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The motion of boids (simulate/flock/boids.h): neighbours by the cell grid, their forces by a
// vector kernel or one pair at a time, then what the world does, and one step of time.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_BOIDS_MOTION_H_
#define FLOCKLIFT_SIMULATE_FLOCK_BOIDS_MOTION_H_

#include <memory>

#include "simulate/flock/motion.h"

namespace flocklift {

template <typename T>
std::unique_ptr<Motion<T>> MakeBoidsMotion(const BoidsParameters<double>& parameters,
                                           const MotionContext& context, const Herd<T>& herd);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_BOIDS_MOTION_H_
