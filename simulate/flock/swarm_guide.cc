// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/swarm_guide.h"

#include <algorithm>
#include <cmath>

#include "simulate/core/check.h"
#include "simulate/core/parallel_for.h"
#include "simulate/fields/solids.h"
#include "simulate/flock/wall_field.h"

namespace flocklift {
namespace {

std::vector<Solid> GoalBalls(std::span<const GoalSpec> goals) {
  std::vector<Solid> balls;
  for (const GoalSpec& goal : goals) balls.emplace_back(Ball{goal.position, goal.reach});
  return balls;
}

std::int8_t Byte(double share) {
  return static_cast<std::int8_t>(std::lround(127 * std::clamp(share, -1.0, 1.0)));
}

}  // namespace

GuideField::GuideField(const World& world, double spacing, const CostOptions& options,
                       std::span<const GoalSpec> goals, int threads)
    : distance_(WallField(world, spacing, threads)), threads_(threads) {
  if (!goals.empty()) cost_.emplace(distance_, options, GoalBalls(goals), threads);
  Pack();
}

void GuideField::SetGoals(std::span<const GoalSpec> goals) {
  if (!cost_) return;
  cost_->SetGoals(GoalBalls(goals));
  Pack();
}

void GuideField::SetExtra(std::span<const float> extra) {
  if (!cost_) return;
  cost_->SetExtra(extra);
  Pack();
}

void GuideField::Pack() {
  const Grid& g = grid();
  // Nodes first, four bytes each; then every cell copies its corners'.
  std::vector<std::int8_t> nodes(4 * g.size());
  const auto count = static_cast<std::int64_t>(g.size());
  const double per_reach = 1 / WallReach();
  ParallelFor(threads_, 0, count, 16384, [&](std::int64_t first, std::int64_t last) {
    for (auto n = static_cast<std::size_t>(first); n < static_cast<std::size_t>(last); ++n) {
      const GuideNode node = cost_ ? cost_->guide()[n] : GuideNode{};
      nodes[4 * n] = Byte(static_cast<double>(node.x));
      nodes[4 * n + 1] = Byte(static_cast<double>(node.y));
      nodes[4 * n + 2] = Byte(static_cast<double>(node.z));
      nodes[4 * n + 3] = Byte(per_reach * static_cast<double>(distance_.values[n]));
    }
  });
  const SwarmGuide view = View(0);
  const auto cells = static_cast<std::size_t>(view.nx) * view.ny * view.nz;
  cells_.resize(kGuideCellBytes * cells + kGuideCellBytes);
  std::int8_t* const to = const_cast<std::int8_t*>(View(0).cells);
  ParallelFor(threads_, 0, static_cast<std::int64_t>(view.ny) * view.nz, 64,
              [&](std::int64_t first, std::int64_t last) {
                for (std::int64_t row = first; row < last; ++row) {
                  const int j = static_cast<int>(row % view.ny),
                            k = static_cast<int>(row / view.ny);
                  std::int8_t* out = to + kGuideCellBytes * row * view.nx;
                  for (int i = 0; i < view.nx; ++i, out += kGuideCellBytes) {
                    for (int corner = 0; corner < 8; ++corner) {
                      const std::size_t node = g.Index(std::min(i + corner % 2, g.nx - 1),
                                                       std::min(j + corner / 2 % 2, g.ny - 1),
                                                       std::min(k + corner / 4, g.nz - 1));
                      std::copy_n(&nodes[4 * node], 4, out + 4 * corner);
                    }
                  }
                }
              });
}

SwarmGuide GuideField::View(double speed) const {
  const Grid& g = grid();
  const auto address = reinterpret_cast<std::uintptr_t>(cells_.data());
  const std::uintptr_t skip = (kGuideCellBytes - address % kGuideCellBytes) % kGuideCellBytes;
  const auto f = [](double value) { return static_cast<float>(value); };
  return {cells_.empty() ? nullptr : cells_.data() + skip,
          f(g.low.x),
          f(g.low.y),
          f(g.low.z),
          f(1 / g.spacing),
          std::max(1, g.nx - 1),
          std::max(1, g.ny - 1),
          std::max(1, g.nz - 1),
          f(speed),
          f(WallReach())};
}

}  // namespace flocklift
