// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/cost_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "simulate/core/check.h"
#include "simulate/core/parallel_for.h"
#include "simulate/fields/goal_nodes.h"

namespace flocklift {
namespace {

constexpr std::int64_t kNodesAtOnce = 8192;

// Where the corners' directions add up to less than this, they say too little [1].
constexpr double kUndecided = 0.05;

}  // namespace

CostField::CostField(const ScalarField& distance, const CostOptions& options,
                     std::span<const Solid> goals, int threads)
    : distance_(distance),
      options_(options),
      goals_(goals.begin(), goals.end()),
      threads_(threads),
      eikonal_(distance.grid) {
  Check(distance.values.size() == grid().size(), "one distance per node is needed");
  Check(options.length_weight > 0 && options.repulsion_weight >= 0 && options.diagonal > 0,
        "a cost field's weights must be positive");
  guide_.resize(grid().size());
  SetSlowness({});
  SetSeeds();
  Prepare();
  CoverAll();
}

void CostField::SetGoals(std::span<const Solid> goals) {
  goals_.assign(goals.begin(), goals.end());
  SetSeeds();
  Prepare();
}

void CostField::SetExtra(std::span<const float> extra) {
  Check(extra.empty() || extra.size() == grid().size(), "one extra cost per node is needed");
  SetSlowness(extra);
  SetSeeds();  // those beside a goal hold a cost
  Prepare();
}

void CostField::SetSlowness(std::span<const float> extra) {
  slowness_.resize(grid().size());
  const auto diagonal = static_cast<float>(options_.diagonal * grid().spacing);
  const auto a = static_cast<float>(options_.length_weight);
  const auto b = static_cast<float>(options_.repulsion_weight);
  const auto nodes = static_cast<std::int64_t>(grid().size());
  ParallelFor(threads_, 0, nodes, kNodesAtOnce, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t n = first; n < last; ++n) {
      const float phi = distance_.values[n];
      slowness_[n] = phi < 0 ? Eikonal::kInfinite : a + b * Repulsion(phi, diagonal);
      if (!extra.empty()) slowness_[n] += extra[n];
    }
  });
  eikonal_.SetSlowness(slowness_);
}

void CostField::SetSeeds() {
  Check(!goals_.empty(), "a cost field needs a goal");
  const Grid& g = grid();
  std::vector<Eikonal::Seed> seeds;
  for (const Solid& goal : goals_) {
    for (const std::size_t inside : GoalNodes(distance_, goal)) {
      seeds.push_back({inside, 0});
      if (SignedDistance(goal, g.Node(inside)) > 0) continue;  // only the nearest
      // A node beside the goal is nearer to it than to the goal's node.
      g.ForEachNeighbour(inside, [&](int /*side*/, std::size_t node) {
        const double distance = SignedDistance(goal, g.Node(node));
        if (eikonal_.IsWall(node) || distance <= 0) return;
        seeds.push_back(
            {node, slowness_[node] * static_cast<float>(std::min(distance, g.spacing))});
      });
    }
  }
  eikonal_.SetSeeds(seeds);
}

void CostField::Prepare() {
  eikonal_.Prepare();
  if (eikonal_.solved_all()) {
    covers_all_ = false;
    covered_.assign(grid().size(), 0);
    return;
  }
  for (const std::size_t node : eikonal_.changed()) {
    Guide(node);
    grid().ForEachNeighbour(node, [this](int /*side*/, std::size_t other) { Guide(other); });
  }
}

void CostField::Cover(std::span<const std::size_t> nodes) {
  if (covers_all_) return;
  for (const std::size_t node : nodes) {
    if (covered_[node] != 0) continue;
    eikonal_.Reach(node);
    Guide(node);
    covered_[node] = 1;
  }
}

void CostField::CoverAll() {
  if (covers_all_) return;
  eikonal_.ReachAll();
  ParallelFor(threads_, 0, static_cast<std::int64_t>(grid().size()), kNodesAtOnce,
              [this](std::int64_t first, std::int64_t last) {
                for (std::int64_t n = first; n < last; ++n) Guide(n);
              });
  covers_all_ = true;
}

// V of a node from C, or from the distance in a wall.
void CostField::Guide(std::size_t node) {
  const Grid& g = grid();
  std::array<float, 3> part{};
  const float cost = eikonal_.At(node);
  if (eikonal_.IsWall(node)) {
    const Vec3d out = distance_.SampleSmooth(g.Node(node)).gradient;
    part = {static_cast<float>(out.x), static_cast<float>(out.y), static_cast<float>(out.z)};
  } else if (cost != Eikonal::kInfinite && cost > 0) {
    const std::array<float, 6> near = eikonal_.Neighbours(node);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float before = near[2 * axis], after = near[2 * axis + 1];
      if (std::min(before, after) < cost)
        part[axis] = before <= after ? before - cost : cost - after;
    }
  }
  const float norm = std::sqrt(part[0] * part[0] + part[1] * part[1] + part[2] * part[2]);
  const float scale = norm > 0 ? 1 / norm : 0;
  guide_[node] = {scale * part[0], scale * part[1], scale * part[2], distance_.values[node]};
}

std::size_t CostField::unreachable() const {
  std::size_t count = 0;
  for (std::size_t node = 0; node < grid().size(); ++node) {
    count += !IsWall(node) && Cost(node) == Eikonal::kInfinite ? 1 : 0;
  }
  return count;
}

Vec3d CostField::Direction(const Vec3d& point) const {
  if (SignedDistance(goals_, point) <= 0) return {};
  Vec3d sum;
  CellOf(grid(), point).ForEachCorner([&](std::size_t index, double weight) {
    const GuideNode& node = guide_[index];
    sum += weight * Vec3d{node.x, node.y, node.z};
  });
  const double norm = Norm(sum);
  if (norm > kUndecided) return sum / norm;
  const GuideNode& nearest = guide_[grid().Nearest(point)];
  return {nearest.x, nearest.y, nearest.z};
}

}  // namespace flocklift
