// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/goal_nodes.h"

#include <cmath>
#include <limits>

#include "simulate/core/check.h"

namespace flocklift {

std::vector<std::size_t> GoalNodes(const ScalarField& distance, const Solid& goal) {
  const Grid& g = distance.grid;
  std::vector<std::size_t> nodes;
  const auto [low, high] = Bounds(goal);
  const GridPlace from = g.Place(g.Nearest(low)), to = g.Place(g.Nearest(high));
  for (int k = from.k; k <= to.k; ++k) {
    for (int j = from.j; j <= to.j; ++j) {
      for (int i = from.i; i <= to.i; ++i) {
        const std::size_t node = g.Index(i, j, k);
        if (distance.values[node] < 0) continue;
        if (SignedDistance(goal, g.Node(i, j, k)) <= 0) nodes.push_back(node);
      }
    }
  }
  if (!nodes.empty()) return nodes;
  double nearest = std::numeric_limits<double>::infinity();
  std::size_t best = 0;
  for (std::size_t node = 0; node < g.size(); ++node) {
    if (distance.values[node] < 0) continue;
    const double away = SignedDistance(goal, g.Node(node));
    if (away >= nearest) continue;
    nearest = away;
    best = node;
  }
  Check(std::isfinite(nearest), "the obstacles leave no room for a goal");
  return {best};
}

}  // namespace flocklift
