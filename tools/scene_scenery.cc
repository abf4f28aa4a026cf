// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/scene_scenery.h"

#include <algorithm>
#include <cstddef>
#include <vector>

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

// A uniform cubic B-spline from the first to the last of its control points: beyond each end one
// more lies opposite to the second.
std::vector<Vec3d> SplineThrough(const std::vector<Vec3d>& points) {
  constexpr int kSteps = 24;  // of each segment
  std::vector<Vec3d> control{2.0 * points[0] - points[1]};
  control.insert(control.end(), points.begin(), points.end());
  control.push_back(2.0 * points.back() - points[points.size() - 2]);
  std::vector<Vec3d> curve{points.front()};
  for (std::size_t k = 0; k + 3 < control.size(); ++k) {
    for (int step = 1; step <= kSteps; ++step) {
      const double t = static_cast<double>(step) / kSteps, s = 1 - t;
      curve.push_back((s * s * s / 6) * control[k] +
                      ((3 * t * t * t - 6 * t * t + 4) / 6) * control[k + 1] +
                      ((3 * s * s * s - 6 * s * s + 4) / 6) * control[k + 2] +
                      (t * t * t / 6) * control[k + 3]);
    }
  }
  return curve;
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
    for (const PathSpec& path : scene.paths) scenery.AddPath(SplineThrough(path.points));
  }
  for (std::size_t k = 0; render.goals && k < scene.goals.size(); ++k) {
    const double reach = scene.goals[k].reach;
    scenery.AddGoal([scene, k](double time) { return PlaceOfGoal(scene, k, time); },
                    reach > 0 ? reach : 0.02 * Norm(box.high - box.low));
  }
  return scenery;
}

}  // namespace flocklift
