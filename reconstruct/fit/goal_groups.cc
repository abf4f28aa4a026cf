// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/goal_groups.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <unordered_map>

namespace flocklift {
namespace {

struct Way {
  Vec3d from, to;
  double end = 0;  // [s]
};

// By id: from the first place to the last.
std::unordered_map<Id, Way> WaysOf(const std::vector<FramePositions>& frames, double time,
                                   double fps) {
  std::unordered_map<Id, Way> ways;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (std::size_t k = 0; k < frames[f].id.size(); ++k) {
      const Vec3d& place = frames[f].position[k];
      Way& way = ways.try_emplace(frames[f].id[k], Way{.from = place, .to = place}).first->second;
      way.to = place;
      way.end = time + static_cast<double>(f) / fps;
    }
  }
  return ways;
}

}  // namespace

std::vector<Vec3d> GoalsAt(const World& world, const std::string& species, double time) {
  std::vector<Vec3d> goals;
  for (std::size_t g = 0; g < world.goals.size(); ++g) {
    const GoalSpec& goal = world.goals[g];
    if (!goal.species.empty() && goal.species != species) continue;
    Vec3d place = GoalPosition(goal, time);
    for (const EventSpec& event : world.events) {
      if (event.time <= time && event.goal && *event.goal == g + 1) place = event.position;
    }
    goals.push_back(place);
  }
  return goals;
}

std::vector<std::size_t> OrderByGoal(const World& world, const std::string& species,
                                     const std::vector<FramePositions>& frames, double time,
                                     double fps, const std::vector<Id>& ids) {
  std::vector<std::size_t> order(ids.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t groups = GoalsAt(world, species, time).size();
  if (groups < 2) return order;
  const std::unordered_map<Id, Way> ways = WaysOf(frames, time, fps);
  // How much nearer each animal comes to each goal, and to the best of them than to the next [m].
  std::vector<std::vector<double>> nearer(ids.size(), std::vector<double>(groups));
  std::vector<double> margin(ids.size());
  for (std::size_t k = 0; k < ids.size(); ++k) {
    const auto found = ways.find(ids[k]);
    const Way way = found == ways.end() ? Way{.from = {}, .to = {}, .end = time} : found->second;
    const std::vector<Vec3d> goals = GoalsAt(world, species, way.end);
    for (std::size_t g = 0; g < groups; ++g) {
      nearer[k][g] = Norm(way.from - goals[g]) - Norm(way.to - goals[g]);
    }
    std::vector<double> sorted = nearer[k];
    std::sort(sorted.rbegin(), sorted.rend());
    margin[k] = sorted[0] - sorted[1];
  }
  // Who is clearest chooses first, as long as there is room in the group.
  std::vector<std::size_t> by_margin = order;
  std::stable_sort(by_margin.begin(), by_margin.end(),
                   [&](std::size_t a, std::size_t b) { return margin[a] > margin[b]; });
  std::vector<std::vector<std::size_t>> members(groups);
  for (const std::size_t k : by_margin) {
    std::optional<std::size_t> best;
    for (std::size_t g = 0; g < groups; ++g) {
      const std::size_t room = (ids.size() + groups - 1 - g) / groups;
      if (members[g].size() < room && (!best || nearer[k][g] > nearer[k][*best])) best = g;
    }
    members[*best].push_back(k);
  }
  for (std::vector<std::size_t>& group : members) std::sort(group.begin(), group.end());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = members[k % groups][k / groups];
  return order;
}

}  // namespace flocklift
