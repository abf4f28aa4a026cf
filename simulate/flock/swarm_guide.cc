// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/swarm_guide.h"

#include <algorithm>
#include <cmath>

#include "simulate/core/check.h"
#include "simulate/core/parallel_for.h"
#include "simulate/fields/clear_line.h"
#include "simulate/fields/solids.h"
#include "simulate/flock/swarm_velocity.h"
#include "simulate/flock/wall_field.h"

namespace flocklift {
namespace {

std::vector<Ball> GoalBalls(std::span<const GoalSpec> goals) {
  std::vector<Ball> balls;
  for (const GoalSpec& goal : goals) balls.push_back({goal.position, goal.reach});
  return balls;
}

std::vector<Solid> Solids(const std::vector<Ball>& balls) { return {balls.begin(), balls.end()}; }

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
    : distance_(WallField(world, spacing, threads)),
      options_(options),
      goals_(GoalBalls(goals)),
      threads_(threads) {
  if (!goals.empty()) cost_.emplace(distance_, options, Solids(goals_), threads);
  PackAll();
}

void GuideField::SetGoals(std::span<const GoalSpec> goals) {
  if (!cost_) return;
  goals_ = GoalBalls(goals);
  cost_->SetGoals(Solids(goals_));
  Unpack();
}

void GuideField::SetExtra(std::span<const float> extra) {
  if (!cost_) return;
  crowded_ = !extra.empty();
  cost_->SetExtra(extra);
  Unpack();
}

void GuideField::Unpack() { packed_.assign(CellCount(View(0)), 0); }

template <typename T>
void GuideField::Cover(const Bodies<T>& animals) {
  if (packed_.empty()) return;
  const SwarmGuide view = View(0);
  for (std::size_t k = 0; k < animals.size(); ++k) {
    const std::size_t cell = PlaceInGuide(view, animals.Position(k)).cell;
    if (packed_[cell] != 0) continue;
    if (!Sees(cell)) cost_->Cover(Corners(cell));
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

// Whether the goal is reached from all of a cell along straight lines on which a metre costs the
// same. The lines from a cell's points are no farther than half its diagonal from that of its
// middle. Goals that the cell touches are for the nodes to tell.
bool GuideField::Sees(std::size_t cell) const {
  if (goals_.size() != 1 || crowded_) return false;
  const Ball& goal = goals_.front();
  const double l = grid().spacing, half = 0.5 * kCellDiagonal * l;
  const GridPlace at = Place(cell);
  const Vec3d middle = grid().Node(at.i, at.j, at.k) + Vec3d{0.5 * l, 0.5 * l, 0.5 * l};
  const double away = goal(middle);
  if (away <= kCellDiagonal * l) return false;
  const Vec3d rim = middle + away * Normalized(goal.centre - middle);
  return IsClearLine(distance_, middle, rim, 2 * options_.diagonal * l + half);
}

void GuideField::PackCell(std::size_t cell) {
  const float per_reach = 1 / static_cast<float>(WallReach());
  std::int8_t* out = const_cast<std::int8_t*>(View(0).cells) + kGuideCellBytes * cell;
  const bool sees = Sees(cell);
  for (const std::size_t corner : Corners(cell)) {
    Vec3d way;
    if (sees) {
      way = Normalized(goals_.front().centre - grid().Node(corner));
    } else if (cost_) {
      const GuideNode& node = cost_->guide()[corner];
      way = {node.x, node.y, node.z};
    }
    for (const double of : {way.x, way.y, way.z}) *out++ = Byte(static_cast<float>(of));
    *out++ = Byte(std::clamp(per_reach * distance_.values[corner], -1.0F, 1.0F));
  }
}

GridPlace GuideField::Place(std::size_t cell) const {
  const SwarmGuide view = View(0);
  const std::size_t row = cell / view.nx;
  return {static_cast<int>(cell % view.nx), static_cast<int>(row % view.ny),
          static_cast<int>(row / view.ny)};
}

std::array<std::size_t, 8> GuideField::Corners(std::size_t cell) const {
  const Grid& g = grid();
  const auto [i, j, k] = Place(cell);
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
