// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/swarm_guide.h"

#include <algorithm>
#include <cmath>

#include "simulate/core/check.h"
#include "simulate/core/parallel_for.h"
#include "simulate/fields/solids.h"
#include "simulate/flock/swarm_velocity.h"
#include "simulate/flock/wall_field.h"

namespace flocklift {
namespace {

std::vector<Solid> GoalBalls(std::span<const GoalSpec> goals) {
  std::vector<Solid> balls;
  for (const GoalSpec& goal : goals) balls.emplace_back(Ball{goal.position, goal.reach});
  return balls;
}

// Of a share in [-1, 1].
std::int8_t Byte(float share) {
  return static_cast<std::int8_t>(127 * share + std::copysign(0.5F, share));
}

std::size_t CellCount(const SwarmGuide& guide) {
  return static_cast<std::size_t>(guide.nx) * guide.ny * guide.nz;
}

}  // namespace

GuideField::GuideField(const World& world, double spacing, const CostOptions& options,
                       std::span<const GoalSpec> goals, int threads)
    : distance_(WallField(world, spacing, threads)), threads_(threads) {
  if (!goals.empty()) cost_.emplace(distance_, options, GoalBalls(goals), threads);
  PackAll();
}

void GuideField::SetGoals(std::span<const GoalSpec> goals) {
  if (!cost_) return;
  cost_->SetGoals(GoalBalls(goals));
  packed_.assign(CellCount(View(0)), 0);
}

void GuideField::SetExtra(std::span<const float> extra) {
  if (!cost_) return;
  cost_->SetExtra(extra);
  packed_.assign(CellCount(View(0)), 0);
}

template <typename T>
void GuideField::Cover(const Bodies<T>& animals) {
  if (packed_.empty()) return;
  const SwarmGuide view = View(0);
  for (std::size_t k = 0; k < animals.size(); ++k) {
    const std::size_t cell = PlaceInGuide(view, animals.Position(k)).cell;
    if (packed_[cell] != 0) continue;
    cost_->Cover(Corners(cell));
    PackCell(cell);
    packed_[cell] = 1;
  }
}

template void GuideField::Cover(const Bodies<float>&);
template void GuideField::Cover(const Bodies<double>&);

void GuideField::PackAll() {
  const auto cells = static_cast<std::int64_t>(CellCount(View(0)));
  cells_.resize(kGuideCellBytes * (static_cast<std::size_t>(cells) + 1));
  ParallelFor(threads_, 0, cells, 4096, [this](std::int64_t first, std::int64_t last) {
    for (std::int64_t cell = first; cell < last; ++cell) PackCell(static_cast<std::size_t>(cell));
  });
}

void GuideField::PackCell(std::size_t cell) {
  const float per_reach = 1 / static_cast<float>(WallReach());
  std::int8_t* out = const_cast<std::int8_t*>(View(0).cells) + kGuideCellBytes * cell;
  for (const std::size_t corner : Corners(cell)) {
    const GuideNode node = cost_ ? cost_->guide()[corner] : GuideNode{};
    for (const float of : {node.x, node.y, node.z}) *out++ = Byte(of);
    *out++ = Byte(std::clamp(per_reach * distance_.values[corner], -1.0F, 1.0F));
  }
}

std::array<std::size_t, 8> GuideField::Corners(std::size_t cell) const {
  const Grid& g = grid();
  const SwarmGuide view = View(0);
  const std::size_t row = cell / view.nx;
  const int i = static_cast<int>(cell % view.nx), j = static_cast<int>(row % view.ny),
            k = static_cast<int>(row / view.ny);
  std::array<std::size_t, 8> corners{};
  for (int c = 0; c < 8; ++c) {
    corners[c] = g.Index(std::min(i + c % 2, g.nx - 1), std::min(j + c / 2 % 2, g.ny - 1),
                         std::min(k + c / 4, g.nz - 1));
  }
  return corners;
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
