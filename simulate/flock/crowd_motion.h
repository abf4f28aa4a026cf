// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The motion of a continuum crowd (simulate/flock/crowd_model.h). Terms of a scene's forces do not
// apply, since nothing here accelerates. Goals may move: they are followed whenever the crowd is
// looked at.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_CROWD_MOTION_H_
#define FLOCKLIFT_SIMULATE_FLOCK_CROWD_MOTION_H_

#include <memory>

#include "simulate/flock/motion.h"

namespace flocklift {

// Puts a herd that walks on the ground there. Throws std::invalid_argument when the species has no
// goal, or the scene no box.
template <typename T>
std::unique_ptr<Motion<T>> MakeCrowdMotion(const CrowdParameters& parameters,
                                           const MotionContext& context, Herd<T>* herd);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_CROWD_MOTION_H_
