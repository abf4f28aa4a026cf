// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The motion of Lin's simulator (simulate/flock/lin_model.h). It moves positions: forces of a scene
// do not apply.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_LIN_MOTION_H_
#define FLOCKLIFT_SIMULATE_FLOCK_LIN_MOTION_H_

#include <memory>

#include "simulate/flock/motion.h"

namespace flocklift {

template <typename T>
std::unique_ptr<Motion<T>> MakeLinMotion(const LinParameters<double>& parameters,
                                         const MotionContext& context);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_LIN_MOTION_H_
