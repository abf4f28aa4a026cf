// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which nodes of a grid a goal holds: those inside it that are not in a wall, or, where there is
// none (a small goal between nodes, or one in a wall), the free node nearest to it.

#ifndef FLOCKLIFT_SIMULATE_FIELDS_GOAL_NODES_H_
#define FLOCKLIFT_SIMULATE_FIELDS_GOAL_NODES_H_

#include <cstddef>
#include <vector>

#include "simulate/fields/grid_field.h"
#include "simulate/fields/solids.h"

namespace flocklift {

// Nodes in ascending order; `distance` to the obstacles, negative in walls. Throws
// std::invalid_argument when every node is in a wall.
std::vector<std::size_t> GoalNodes(const ScalarField& distance, const Solid& goal);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FIELDS_GOAL_NODES_H_
