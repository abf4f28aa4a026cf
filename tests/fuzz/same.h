// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Are two values the same, up to what a file keeps?

#ifndef FLOCKLIFT_TESTS_FUZZ_SAME_H_
#define FLOCKLIFT_TESTS_FUZZ_SAME_H_

#include <algorithm>
#include <cmath>

#include "simulate/core/trajectory.h"

namespace flocklift {

inline bool Near(double a, double b, double absolute, double relative) {
  return std::abs(a - b) <= absolute + relative * std::max(std::abs(a), std::abs(b));
}

inline bool Same(const Tracks& a, const Tracks& b, double tolerance) {
  const auto same_row = [&](const Detection& p, const Detection& q) {
    return p.frame == q.frame && Near(p.box.left, q.box.left, tolerance, 0) &&
           Near(p.box.top, q.box.top, tolerance, 0) &&
           Near(p.box.width, q.box.width, tolerance, 0) &&
           Near(p.box.height, q.box.height, tolerance, 0) &&
           Near(p.confidence, q.confidence, tolerance, 0);
  };
  const auto same_tracklet = [&](const Tracklet& p, const Tracklet& q) {
    return p.id == q.id && std::equal(p.detections.begin(), p.detections.end(),
                                      q.detections.begin(), q.detections.end(), same_row);
  };
  return a.fps == b.fps && std::equal(a.tracklets.begin(), a.tracklets.end(), b.tracklets.begin(),
                                      b.tracklets.end(), same_tracklet);
}

inline bool Same(const Trajectories& a, const Trajectories& b, double relative) {
  const auto near = [&](double p, double q) { return Near(p, q, 0, relative); };
  const auto same_vector = [&](const Vec3d& p, const Vec3d& q) {
    return near(p.x, q.x) && near(p.y, q.y) && near(p.z, q.z);
  };
  // Quaternions are normalised when they are read.
  const auto same_rotation = [&](const Quaternion& p, const Quaternion& q) {
    constexpr double kRounding = 2e-7;
    return Near(p.w, q.w, kRounding, 0) && Near(p.x, q.x, kRounding, 0) &&
           Near(p.y, q.y, kRounding, 0) && Near(p.z, q.z, kRounding, 0);
  };
  const auto same_point = [&](const TrajectoryPoint& p, const TrajectoryPoint& q) {
    return p.frame == q.frame && same_vector(p.position, q.position) &&
           same_vector(p.velocity, q.velocity) &&
           same_rotation(p.world_from_body, q.world_from_body) && near(p.sd_depth, q.sd_depth);
  };
  const auto same_trajectory = [&](const Trajectory& p, const Trajectory& q) {
    return p.id == q.id && std::equal(p.points.begin(), p.points.end(), q.points.begin(),
                                      q.points.end(), same_point);
  };
  return a.fps == b.fps && a.has_velocity == b.has_velocity &&
         a.has_orientation == b.has_orientation && a.has_sd_depth == b.has_sd_depth &&
         std::equal(a.trajectories.begin(), a.trajectories.end(), b.trajectories.begin(),
                    b.trajectories.end(), same_trajectory);
}

// What every reader of trajectories and tracks promises.
template <typename Animals, typename RowsOf>
bool IsOrdered(const Animals& animals, const RowsOf& rows_of) {
  Id last_id = 0;
  for (const auto& animal : animals) {
    if (animal.id <= last_id || rows_of(animal).empty()) return false;
    last_id = animal.id;
    int last_frame = 0;
    for (const auto& row : rows_of(animal)) {
      if (row.frame <= last_frame) return false;
      last_frame = row.frame;
    }
  }
  return true;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_FUZZ_SAME_H_
