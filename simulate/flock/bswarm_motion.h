// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// BSwarm at work (simulate/flock/bswarm_model.h).

#ifndef FLOCKLIFT_SIMULATE_FLOCK_BSWARM_MOTION_H_
#define FLOCKLIFT_SIMULATE_FLOCK_BSWARM_MOTION_H_

#include <memory>

#include "simulate/flock/motion.h"

namespace flocklift {

template <typename T>
std::unique_ptr<Motion<T>> MakeBSwarmMotion(const BSwarmParameters& parameters,
                                            const MotionContext& context, const Herd<T>& herd);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_BSWARM_MOTION_H_
