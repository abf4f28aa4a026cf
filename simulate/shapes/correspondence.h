// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which agent goes to which sample: a bijection of short ways, sum_i |target_i - agent_i|^2 small.
// Both sets are first ordered along a Hilbert curve through their own bounding cubes and matched
// rank by rank; then two agents near each other, or on the way to targets near each other, exchange
// their targets for as long as it shortens the ways: it does exactly if
//   (agent_i - agent_j) . (target_i - target_j) < 0,
// whatever lies between the two sets. N log N; not the optimum, but near it (the tests say how
// near).

#ifndef FLOCKLIFT_SIMULATE_SHAPES_CORRESPONDENCE_H_
#define FLOCKLIFT_SIMULATE_SHAPES_CORRESPONDENCE_H_

#include <cstdint>
#include <vector>

#include "simulate/core/vec3.h"

namespace flocklift {

struct MatchOptions {
  int neighbours = 12;  // agents (and targets) that each one compares itself with
  int max_rounds = 30;  // through all agents; 0: the order along the curve alone
};

// target_of[i] for agent i. Throws std::invalid_argument when there are not as many targets as
// agents.
std::vector<std::uint32_t> MatchTargets(const std::vector<Vec3d>& agents,
                                        const std::vector<Vec3d>& targets,
                                        const MatchOptions& options);

// sum_i |target - agent|^2 [m^2].
double MatchCost(const std::vector<Vec3d>& agents, const std::vector<Vec3d>& targets,
                 const std::vector<std::uint32_t>& target_of);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_CORRESPONDENCE_H_
