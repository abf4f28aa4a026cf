// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The motion of the noise-aware swarm (simulate/flock/swarm_model.h). Terms of a scene's forces do
// not apply, since nothing here accelerates; wind carries the animals along.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_SWARM_MOTION_H_
#define FLOCKLIFT_SIMULATE_FLOCK_SWARM_MOTION_H_

#include <memory>

#include "simulate/flock/motion.h"

namespace flocklift {

template <typename T>
std::unique_ptr<Motion<T>> MakeSwarmMotion(const SwarmParameters& parameters,
                                           const MotionContext& context, const Herd<T>& herd);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_SWARM_MOTION_H_
