// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/crowd_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/core/parallel_for.h"
#include "simulate/fields/goal_nodes.h"

namespace flocklift {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr std::int64_t kNodesAtOnce = 4096;
constexpr std::array<Vec3d, 6> kSides = {
    {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};

// What a node costs by way of one axis: the cheaper neighbour, and the step from there.
struct Way {
  float cost = kInfinite, step = 0;
  std::size_t side = 0;
};

// The ways along the three axes, the cheapest neighbour first; infinite where there is none.
using Ways = std::array<Way, 3>;

std::size_t Beside(const Grid& g, std::size_t node, std::size_t side) {
  const std::array<std::size_t, 3> stride = {1, static_cast<std::size_t>(g.nx),
                                             static_cast<std::size_t>(g.nx) * g.ny};
  return side % 2 == 0 ? node - stride[side / 2] : node + stride[side / 2];
}

// The cheaper way along each axis, from the neighbours' potentials and the steps.
Ways WaysTo(const Grid& g, const std::array<float, 6>& step, const std::vector<float>& potential,
            std::size_t node) {
  Ways ways;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Way best;
    for (std::size_t side = 2 * axis; side < 2 * axis + 2; ++side) {
      if (step[side] == kInfinite) continue;
      const float cost = potential[Beside(g, node, side)];
      if (cost == kInfinite || cost + step[side] >= best.cost + best.step) continue;
      best = {cost, step[side], side};
    }
    ways[axis] = best;
  }
  const auto order = [](Way* a, Way* b) {
    if (b->cost < a->cost) std::swap(*a, *b);
  };
  order(&ways[0], &ways[1]);
  order(&ways[1], &ways[2]);
  order(&ways[0], &ways[1]);
  return ways;
}

// sum of ((phi - cost) / step)^2 = 1 over those of the ways whose neighbour is below phi.
float Solution(const Ways& ways) {
  const float least = ways[0].cost;
  if (least == kInfinite) return kInfinite;
  float phi = ways[0].step;   // above `least`
  float a = 0, b = 0, c = 0;  // a phi^2 - 2 b phi + c = 1
  for (const Way& way : ways) {
    const float above = way.cost - least;
    if (above >= phi) break;
    const float weight = 1 / (way.step * way.step);
    a += weight;
    b += weight * above;
    c += weight * above * above;
    const float root = b * b - a * (c - 1);
    if (root >= 0) phi = std::max((b + std::sqrt(root)) / a, above);
  }
  return least + phi;
}

}  // namespace

CrowdField::CrowdField(const ScalarField& distance, const CrowdOptions& options,
                       std::span<const std::vector<Solid>> goals, int threads)
    : distance_(distance), options_(options), threads_(threads) {
  const CrowdOptions& o = options;
  Check(distance.values.size() == grid().size(), "one distance per node is needed");
  Check(o.length_weight >= 0 && o.time_weight > 0 && o.discomfort_weight >= 0 && o.diagonal > 0,
        "a crowd field's weights must not be negative, and time must cost something");
  Check(o.min_speed > 0 && o.max_speed >= o.min_speed, "a crowd's speeds must be 0 < min <= max");
  Check(o.density_exponent > 0 && o.density_low >= std::exp2(-o.density_exponent) &&
            o.density_high > o.density_low,
        "a crowd's densities must be 2^-exponent <= low < high");
  const std::size_t nodes = grid().size();
  density_.resize(nodes);
  flow_.resize(nodes);
  discomfort_.resize(nodes);
  step_.resize(nodes);
  const double diagonal = o.diagonal * grid().spacing;
  for (std::size_t n = 0; n < nodes; ++n) {
    discomfort_[n] = Repulsion(static_cast<double>(distance.values[n]), diagonal);
  }
  groups_.resize(goals.size());
  for (Group& group : groups_) {
    group.potential.resize(nodes);
    group.velocity.resize(nodes);
  }
  SetGoals(goals);
  Update({}, {});
}

void CrowdField::SetGoals(std::span<const std::vector<Solid>> goals) {
  Check(goals.size() == groups_.size(), "a crowd keeps its groups");
  for (std::size_t k = 0; k < goals.size(); ++k) {
    Check(!goals[k].empty(), "a group of a crowd needs a goal");
    groups_[k].goals = goals[k];
    groups_[k].seeds.clear();
    for (const Solid& goal : goals[k]) {
      const std::vector<std::size_t> inside = GoalNodes(distance_, goal);
      groups_[k].seeds.insert(groups_[k].seeds.end(), inside.begin(), inside.end());
    }
  }
}

double CrowdField::Speed(std::size_t node, const Vec3d& direction) const {
  const CrowdOptions& o = options_;
  const double with_flow = std::clamp(Dot(flow_[node], direction), o.min_speed, o.max_speed);
  const double crowded =
      std::clamp((density_[node] - o.density_low) / (o.density_high - o.density_low), 0.0, 1.0);
  return o.max_speed + crowded * (with_flow - o.max_speed);
}

void CrowdField::Update(std::span<const Vec3d> positions, std::span<const Vec3d> velocities) {
  Check(positions.size() == velocities.size(), "every animal of a crowd needs a velocity");
  std::fill(density_.begin(), density_.end(), 0);
  std::fill(flow_.begin(), flow_.end(), Vec3d{});
  for (std::size_t a = 0; a < positions.size(); ++a) {
    const GridCell cell = CellOf(grid(), positions[a]);
    for (int corner = 0; corner < 8; ++corner) {
      const bool x = corner & 1, y = corner & 2, z = corner & 4;
      // An axis of one node has no second corner, and no say.
      if ((x && cell.step_x == 0) || (y && cell.step_y == 0) || (z && cell.step_z == 0)) continue;
      const double least = std::min(
          {x ? cell.u.x : 1 - cell.u.x, y ? cell.u.y : 1 - cell.u.y, z ? cell.u.z : 1 - cell.u.z});
      const double weight = std::pow(least, options_.density_exponent);
      const std::size_t node =
          cell.index + (x ? cell.step_x : 0) + (y ? cell.step_y : 0) + (z ? cell.step_z : 0);
      density_[node] += weight;
      flow_[node] += weight * velocities[a];
    }
  }
  const Grid& g = grid();
  const CrowdOptions& o = options_;
  ParallelFor(threads_, 0, static_cast<std::int64_t>(g.size()), kNodesAtOnce,
              [&](std::int64_t first, std::int64_t last) {
                for (std::int64_t n = first; n < last; ++n) {
                  if (density_[n] > 0) flow_[n] = flow_[n] / density_[n];
                }
              });
  ParallelFor(threads_, 0, static_cast<std::int64_t>(g.size()), kNodesAtOnce,
              [&](std::int64_t first, std::int64_t last) {
                for (std::int64_t n = first; n < last; ++n) {
                  step_[n].fill(kInfinite);
                  if (IsWall(n)) continue;
                  g.ForEachNeighbour(n, [&](std::size_t side, std::size_t other) {
                    if (IsWall(other)) return;
                    const double f = Speed(other, kSides[side]);
                    const double cost = (o.length_weight * f + o.time_weight +
                                         o.discomfort_weight * discomfort_[other]) /
                                        f;
                    step_[n][side] = static_cast<float>(cost * g.spacing);
                  });
                }
              });
  ParallelFor(threads_, 0, static_cast<std::int64_t>(groups_.size()), 1,
              [&](std::int64_t group, std::int64_t /*end*/) { Solve(&groups_[group]); });
}

void CrowdField::Solve(Group* group) const {
  std::fill(group->potential.begin(), group->potential.end(), kInfinite);
  group->heap.Clear();
  for (const std::size_t node : group->seeds) {
    group->potential[node] = 0;
    group->heap.Push(0, static_cast<std::uint32_t>(node));
  }
  while (!group->heap.Empty()) {
    const auto entry = group->heap.Pop();
    if (entry.cost != group->potential[entry.node]) continue;
    grid().ForEachNeighbour(entry.node, [&](int /*side*/, std::size_t other) {
      if (!(group->potential[other] > entry.cost)) return;
      const float cost = Solution(WaysTo(grid(), step_[other], group->potential, other));
      if (!(cost < group->potential[other])) return;
      group->potential[other] = cost;
      group->heap.Push(cost, static_cast<std::uint32_t>(other));
    });
  }
  for (std::size_t node = 0; node < grid().size(); ++node) {
    group->velocity[node] = VelocityAt(*group, node);
  }
}

Vec3d CrowdField::VelocityAt(const Group& group, std::size_t node) const {
  const float here = group.potential[node];
  if (IsWall(node)) {  // the way out
    return options_.max_speed * Normalized(distance_.SampleSmooth(grid().Node(node)).gradient);
  }
  if (here == 0 || here == kInfinite) return {};
  Vec3d speed;  // towards the cheaper neighbours
  double squared = 0;
  const Ways ways = WaysTo(grid(), step_[node], group.potential, node);
  for (const Way& way : ways) {
    const double drop = here - way.cost;
    if (!(drop > 0)) break;
    squared += drop * drop;
    speed += Speed(Beside(grid(), node, way.side), kSides[way.side]) * drop * kSides[way.side];
  }
  return squared > 0 ? speed / std::sqrt(squared) : Vec3d{};
}

Vec3d CrowdField::Velocity(std::size_t group, const Vec3d& point) const {
  const Group& of = groups_[group];
  if (SignedDistance(of.goals, point) <= 0) return {};
  Vec3d sum;
  CellOf(grid(), point).ForEachCorner([&](std::size_t node, double weight) {
    sum += weight * of.velocity[node];
  });
  // Where the corners' ways cancel, both are equally good: the nearest node's.
  if (Norm(sum) > 0.05 * options_.min_speed) return sum;
  return of.velocity[grid().Nearest(point)];
}

}  // namespace flocklift
