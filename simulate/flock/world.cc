// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/world.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flocklift {

Vec3d GoalPosition(const GoalSpec& goal, double time) {
  if (!goal.waypoints.empty()) {
    const auto after =
        std::find_if(goal.waypoints.begin(), goal.waypoints.end(),
                     [time](const Waypoint& waypoint) { return waypoint.time > time; });
    if (after == goal.waypoints.begin()) return after->position;
    const Waypoint& before = *(after - 1);
    if (after == goal.waypoints.end()) return before.position;
    const double share = (time - before.time) / (after->time - before.time);
    return before.position + share * (after->position - before.position);
  }
  if (goal.period <= 0) return goal.position;
  const double phase = 2 * std::numbers::pi * time / goal.period;
  return goal.position + goal.radius * Vec3d{std::cos(phase), std::sin(phase), 0};
}

}  // namespace flocklift
