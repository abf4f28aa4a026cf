// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Boids (equations.md, section 1) as a process model: accelerations by the simulator's own pairs
// and walls, own slopes through ceres::Jet, radii and tapers as parameters. All pairs are looked
// at. Parameters are in the model's own `time_unit`, as everywhere outside the engine.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_BOIDS_PROCESS_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_BOIDS_PROCESS_H_

#include <optional>
#include <string>
#include <vector>

#include "reconstruct/fit/process_model.h"
#include "simulate/flock/boids.h"

namespace flocklift {

// The parameters that can be freed; none where an edge is hard, neighbours are topological, the
// noise has a memory or stands in space, or animals have cruising speeds of their own.
std::vector<std::string> SmoothBoidsParameters(const BoidsParameters<double>& given);

// Fills evaluate and speed_range for process->free.
void SetBoidsProcess(const BoidsParameters<double>& given, const std::optional<Region>& walls,
                     ProcessModel* process);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_BOIDS_PROCESS_H_
