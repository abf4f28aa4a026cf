// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The last part of a flock's time, held out of a fit and predicted by it.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_HELD_OUT_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_HELD_OUT_H_

#include "simulate/core/trajectory.h"

namespace flocklift {

// The first frame of the last `share` of the time.
int FirstHeldOut(const Trajectories& flock, double share);

// Without frames from `split` on, and animals that have no others.
Trajectories BeforeFrame(const Trajectories& flock, int split);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_HELD_OUT_H_
