// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/scene_scenery.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "simulate/shapes/spline_path.h"

namespace flocklift {
namespace {

// The goal of the given place in the file, moved by the events up to `time`.
Vec3d PlaceOfGoal(const Scene& scene, std::size_t index, double time) {
  GoalSpec goal = scene.goals[index];
  for (const EventSpec& event : scene.events) {
    if (event.time > time || !event.goal || *event.goal != index + 1) continue;
    goal.position = event.position;
    goal.waypoints.clear();
  }
  return GoalPosition(goal, time);
}

// The path as it is flown (simulate/shapes/spline_path.h), in points close enough to look smooth.
std::vector<Vec3d> PointsAlong(const std::vector<Vec3d>& control) {
  constexpr std::size_t kSteps = 24;  // from one control point to the next
  const SplinePath path(control, /*closed=*/false);
  const std::size_t steps = kSteps * (control.size() - 1);
  std::vector<Vec3d> points;
  for (std::size_t k = 0; k <= steps; ++k) {
    points.push_back(
        path.Position(path.length() * static_cast<double>(k) / static_cast<double>(steps)));
  }
  return points;
}

}  // namespace

Scenery SceneObstacles(std::span<const Obstacle> obstacles) {
  Scenery scenery;
  for (const Obstacle& obstacle : obstacles) scenery.AddObstacle(obstacle.mesh);
  return scenery;
}

Scenery SceneScenery(const Scene& scene, std::span<const Obstacle> obstacles) {
  const RenderSpec& render = scene.render;
  Scenery scenery;
  if (render.obstacles) scenery = SceneObstacles(obstacles);
  const Region& box = scene.box;
  if (render.ground) {
    scenery.AddGround({{box.low.x, box.low.y, 0}, {box.high.x, box.high.y, 0}});
  }
  if (render.paths) {
    for (const PathSpec& path : scene.paths) scenery.AddPath(PointsAlong(path.points));
  }
  for (std::size_t k = 0; render.goals && k < scene.goals.size(); ++k) {
    const double reach = scene.goals[k].reach;
    scenery.AddGoal([scene, k](double time) { return PlaceOfGoal(scene, k, time); },
                    reach > 0 ? reach : 0.02 * Norm(box.high - box.low));
  }
  return scenery;
}

}  // namespace flocklift
