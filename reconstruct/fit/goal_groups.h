// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which goal each animal of a crowd walks to. The model gives animal k (from 0) to goal k modulo
// their number (simulate/flock/crowd_model.h), and ids of a recording say nothing about k: animals
// are told apart by how much nearer to each goal they come, and ordered so that the model gives
// them the goals they walk to, in groups of equal size as it has them.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_GOAL_GROUPS_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_GOAL_GROUPS_H_

#include <cstddef>
#include <string>
#include <vector>

#include "reconstruct/fit/motion_statistics.h"
#include "simulate/flock/world.h"

namespace flocklift {

// The goals of a species as they stand at a time, after the events that have moved them by then.
std::vector<Vec3d> GoalsAt(const World& world, const std::string& species, double time);

// The places in `ids` of the animals, in the model's order. The first of the frames is at `time`
// [s]; who is in none of them takes what room is left.
std::vector<std::size_t> OrderByGoal(const World& world, const std::string& species,
                                     const std::vector<FramePositions>& frames, double time,
                                     double fps, const std::vector<Id>& ids);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_GOAL_GROUPS_H_
