// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/trajectory.h"

#include <algorithm>
#include <limits>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

template <typename Animals, typename Rows>
FrameSpan SpanOfRows(const Animals& animals, Rows rows_of) {
  FrameSpan span{std::numeric_limits<int>::max(), std::numeric_limits<int>::min()};
  for (const auto& animal : animals) {
    const auto& rows = rows_of(animal);
    if (rows.empty()) continue;
    span.first = std::min(span.first, rows.front().frame);
    span.last = std::max(span.last, rows.back().frame);
  }
  return span.first > span.last ? FrameSpan{} : span;
}

}  // namespace

void ComputeVelocities(double fps, Trajectories* trajectories) {
  Check(fps > 0, "fps must be positive to compute velocities");
  for (Trajectory& trajectory : trajectories->trajectories) {
    auto& points = trajectory.points;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const TrajectoryPoint& before = points[k > 0 ? k - 1 : k];
      const TrajectoryPoint& after = points[k + 1 < points.size() ? k + 1 : k];
      const int frames = after.frame - before.frame;
      points[k].velocity =
          frames > 0 ? (after.position - before.position) * (fps / frames) : Vec3d{};
    }
  }
  trajectories->has_velocity = true;
}

FlockState StateAtFrame(const Trajectories& trajectories, int frame) {
  FlockState state;
  for (const Trajectory& trajectory : trajectories.trajectories) {
    const auto point =
        std::lower_bound(trajectory.points.begin(), trajectory.points.end(), frame,
                         [](const TrajectoryPoint& p, int wanted) { return p.frame < wanted; });
    if (point == trajectory.points.end() || point->frame != frame) continue;
    state.id.push_back(trajectory.id);
    state.position.push_back(point->position);
    state.velocity.push_back(point->velocity);
  }
  return state;
}

FrameSpan SpanOf(const Trajectories& trajectories) {
  return SpanOfRows(
      trajectories.trajectories, [](const Trajectory& t) -> const auto& { return t.points; });
}

FrameSpan SpanOf(const Tracks& tracks) {
  return SpanOfRows(
      tracks.tracklets, [](const Tracklet& t) -> const auto& { return t.detections; });
}

}  // namespace flocklift
