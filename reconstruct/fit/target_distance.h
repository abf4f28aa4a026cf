// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How far animals are from what a scene gives them to fly to: of a shape swarm and of tetrahedra
// that morph the surface of the shape, as it is and where it is then; of others the nearest goal.
// At a few frames, spread evenly. World frame; metres, seconds.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_TARGET_DISTANCE_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_TARGET_DISTANCE_H_

#include <cstddef>
#include <functional>
#include <vector>

#include "reconstruct/fit/engine_flight.h"

namespace flocklift::internal {

// For frames that compare with a start's; empty where there is nothing to fly to. Safe to call from
// several threads.
TargetDistances MakeTargetDistances(const FlightStart& start);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_TARGET_DISTANCE_H_
