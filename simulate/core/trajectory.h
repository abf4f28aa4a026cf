// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Animals in space over time. World frame: right-handed, z up, metres. Frames count from 1.

#ifndef FLOCKLIFT_SIMULATE_CORE_TRAJECTORY_H_
#define FLOCKLIFT_SIMULATE_CORE_TRAJECTORY_H_

#include <optional>
#include <vector>

#include "simulate/core/observations.h"
#include "simulate/core/rigid3.h"
#include "simulate/core/vec3.h"

namespace flocklift {

// One animal in one frame, in the world frame.
struct TrajectoryPoint {
  int frame = 0;
  Vec3d position;
  Vec3d velocity;
  Quaternion world_from_body;  // body x forward, z up
  double sd_depth = 0;         // 1 sigma along depth, common scale included [m]
};

// The path of one animal by increasing frame, gaps allowed.
struct Trajectory {
  Id id = 0;
  std::vector<TrajectoryPoint> points;
};

// All trajectories of a sequence, by increasing id, and which of the optional columns mean
// anything.
struct Trajectories {
  std::optional<double> fps;  // [1/s]
  bool has_velocity = false;
  bool has_orientation = false;
  bool has_sd_depth = false;
  std::vector<Trajectory> trajectories;
};

// Fills the velocities from the positions: central differences inside a run of frames (over the
// frames that are there), one-sided at its ends, 0 for a single point. Sets has_velocity.
void ComputeVelocities(double fps, Trajectories* trajectories);

// One state of the whole flock; index k is the same animal in every array.
struct FlockState {
  std::vector<Id> id;
  std::vector<Vec3d> position;  // world [m]
  std::vector<Vec3d> velocity;  // world [m/s]

  std::size_t size() const { return id.size(); }
};

// The animals that are there in `frame` (velocities must have been filled).
FlockState StateAtFrame(const Trajectories& trajectories, int frame);

// First and last frame of any animal; {0, -1} when there is none.
struct FrameSpan {
  int first = 0, last = -1;
};
FrameSpan SpanOf(const Trajectories& trajectories);
FrameSpan SpanOf(const Tracks& tracks);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_TRAJECTORY_H_
