// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The motion of a shape-constrained swarm (simulate/flock/shape_model.h): where everybody belongs
// now, neighbours by the cell grid, curl noise where each animal is, one step of time, then
// obstacles take away what flies into them and minimum-distance enforcement parts who is too near.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_SHAPE_MOTION_H_
#define FLOCKLIFT_SIMULATE_FLOCK_SHAPE_MOTION_H_

#include <memory>

#include "simulate/flock/motion.h"
#include "simulate/flock/shape_model.h"

namespace flocklift {

// Throws std::invalid_argument when the species has no [[shape]].
template <typename T>
std::unique_ptr<Motion<T>> MakeShapeMotion(const ShapeParameters& parameters,
                                           const MotionContext& context, const Herd<T>& herd);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_SHAPE_MOTION_H_
