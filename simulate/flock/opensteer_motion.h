// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// OpenSteer's boids at work (simulate/flock/opensteer_model.h).

#ifndef FLOCKLIFT_SIMULATE_FLOCK_OPENSTEER_MOTION_H_
#define FLOCKLIFT_SIMULATE_FLOCK_OPENSTEER_MOTION_H_

#include <memory>

#include "simulate/flock/motion.h"

namespace flocklift {

template <typename T>
std::unique_ptr<Motion<T>> MakeOpenSteerMotion(const OpenSteerParameters& parameters,
                                               const MotionContext& context, const Herd<T>& herd);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_OPENSTEER_MOTION_H_
