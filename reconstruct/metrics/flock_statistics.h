// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What describes a flock as a whole, frame by frame:
//   polarisation  phi = | 1/N sum_i v_i / |v_i| |,  1 when all fly the same way, near 0 in disorder
//                 (Vicsek et al. 1995)
//   nearest-neighbour distance  d_i = min_{j != i} |x_j - x_i|
//   speed  |v_i|

#ifndef FLOCKLIFT_RECONSTRUCT_METRICS_FLOCK_STATISTICS_H_
#define FLOCKLIFT_RECONSTRUCT_METRICS_FLOCK_STATISTICS_H_

#include <optional>
#include <span>
#include <vector>

#include "simulate/core/trajectory.h"

namespace flocklift {

// In [0, 1]; animals that stand still have no direction and do not count. Nothing when none moves.
std::optional<double> Polarisation(std::span<const Vec3d> velocities);

// One distance per animal [m], exact; empty for fewer than two. A sweep along the longest axis:
// far below quadratic for flocks that fill space.
std::vector<double> NearestNeighbourDistances(std::span<const Vec3d> positions);

struct FlockStatistics {
  int frame = 0;
  int count = 0;                                           // animals that are there
  std::optional<double> polarisation;                      // in [0, 1]
  double speed_low = 0, speed_median = 0, speed_high = 0;  // 10th, 50th, 90th percentile [m/s]
  std::optional<double> neighbour_low, neighbour_median, neighbour_high;  // likewise [m]
};

// The states of the flock in each frame that has an animal, by increasing frame. Velocities must
// have been filled (ComputeVelocities).
class StatesByFrame {
 public:
  explicit StatesByFrame(const Trajectories& trajectories);
  const std::vector<int>& frames() const { return frames_; }
  const FlockState& state(std::size_t k) const { return states_[k]; }

 private:
  std::vector<int> frames_;
  std::vector<FlockState> states_;
};

// Every `stride`-th frame that has an animal, by increasing frame.
std::vector<FlockStatistics> ComputeFlockStatistics(const StatesByFrame& states, int stride = 1);

// Steps from one row of an animal to its next, as the speed they would need: where a path jumps,
// it shows here, whatever the velocities of the file say.
struct StepStatistics {
  std::size_t steps = 0;
  double median = 0, p99 = 0, largest = 0;  // [m/s]
  std::size_t jumps = 0;                    // steps of more than kJump times the median
  static constexpr double kJump = 3;
};
StepStatistics ComputeSteps(const Trajectories& trajectories, double fps);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_METRICS_FLOCK_STATISTICS_H_
