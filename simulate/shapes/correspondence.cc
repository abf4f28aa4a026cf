// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/correspondence.h"

#include <cstddef>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/core/parallel_for.h"
#include "simulate/shapes/hilbert.h"
#include "simulate/shapes/nearest.h"

namespace flocklift {

std::vector<std::uint32_t> MatchTargets(const std::vector<Vec3d>& agents,
                                        const std::vector<Vec3d>& targets,
                                        const MatchOptions& options) {
  Check(agents.size() == targets.size(), "matching needs as many targets as agents");
  const std::vector<std::uint32_t> agent_order = internal::HilbertOrder(agents);
  const std::vector<std::uint32_t> target_order = internal::HilbertOrder(targets);
  std::vector<std::uint32_t> target_of(agents.size()), agent_of(agents.size());
  for (std::size_t k = 0; k < agents.size(); ++k) target_of[agent_order[k]] = target_order[k];
  for (std::uint32_t i = 0; i < agents.size(); ++i) agent_of[target_of[i]] = i;

  ThreadPool pool(1);
  const auto near_agents = internal::NearestOthers(agents, options.neighbours, &pool);
  const auto near_targets = internal::NearestOthers(targets, options.neighbours, &pool);
  bool shortened = true;
  const auto exchange_if_shorter = [&](std::uint32_t i, std::uint32_t j) {
    const Vec3d between_targets = targets[target_of[i]] - targets[target_of[j]];
    if (!(Dot(agents[i] - agents[j], between_targets) < 0)) return;
    std::swap(target_of[i], target_of[j]);
    agent_of[target_of[i]] = i;
    agent_of[target_of[j]] = j;
    shortened = true;
  };
  for (int round = 0; round < options.max_rounds && shortened; ++round) {
    shortened = false;
    for (std::uint32_t i = 0; i < agents.size(); ++i) {
      for (const std::uint32_t j : near_agents[i]) exchange_if_shorter(i, j);
      const std::uint32_t target = target_of[i];
      for (const std::uint32_t other : near_targets[target])
        exchange_if_shorter(i, agent_of[other]);
    }
  }
  return target_of;
}

double MatchCost(const std::vector<Vec3d>& agents, const std::vector<Vec3d>& targets,
                 const std::vector<std::uint32_t>& target_of) {
  double sum = 0;
  for (std::size_t i = 0; i < agents.size(); ++i) {
    sum += SquaredNorm(targets[target_of[i]] - agents[i]);
  }
  return sum;
}

}  // namespace flocklift
