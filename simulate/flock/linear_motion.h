// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The motion of the linear reference flock (simulate/flock/linear_model.h).

#ifndef FLOCKLIFT_SIMULATE_FLOCK_LINEAR_MOTION_H_
#define FLOCKLIFT_SIMULATE_FLOCK_LINEAR_MOTION_H_

#include <memory>

#include "simulate/flock/motion.h"

namespace flocklift {

template <typename T>
std::unique_ptr<Motion<T>> MakeLinearMotion(const LinearParameters<double>& parameters,
                                            const MotionContext& context);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_LINEAR_MOTION_H_
