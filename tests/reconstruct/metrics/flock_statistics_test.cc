// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/metrics/flock_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

TrajectoryPoint At(int frame, const Vec3d& position, const Vec3d& velocity) {
  TrajectoryPoint point;
  point.frame = frame;
  point.position = position;
  point.velocity = velocity;
  return point;
}

TEST(FlockStatistics, PolarisationByHand) {
  const std::vector<Vec3d> aligned = {{1, 0, 0}, {30, 0, 0}};  // speed does not matter
  EXPECT_DOUBLE_EQ(*Polarisation(aligned), 1);
  const std::vector<Vec3d> opposed = {{1, 0, 0}, {-5, 0, 0}};
  EXPECT_DOUBLE_EQ(*Polarisation(opposed), 0);
  const std::vector<Vec3d> square = {{1, 0, 0}, {0, 2, 0}};
  EXPECT_NEAR(*Polarisation(square), std::sqrt(0.5), 1e-15);
  const std::vector<Vec3d> one_stands = {{1, 0, 0}, {0, 0, 0}};
  EXPECT_DOUBLE_EQ(*Polarisation(one_stands), 1);
  EXPECT_FALSE(Polarisation(std::vector<Vec3d>{{0, 0, 0}}).has_value());
  EXPECT_FALSE(Polarisation({}).has_value());
}

TEST(FlockStatistics, NeighbourDistancesAgreeWithBruteForce) {
  for (int trial = 0; trial < 50; ++trial) {
    Rng rng(1, trial);
    const std::size_t n = 2 + rng.Below(60);
    const bool on_a_grid = trial % 2 == 0;  // equal coordinates, equal distances
    std::vector<Vec3d> positions(n);
    for (Vec3d& p : positions) {
      p = {rng.Uniform(0, 5), rng.Uniform(0, 50), rng.Uniform(0, 5)};
      if (on_a_grid) p = {std::round(p.x), std::round(p.y), std::round(p.z)};
    }
    const std::vector<double> distances = NearestNeighbourDistances(positions);
    ASSERT_EQ(distances.size(), n);
    for (std::size_t i = 0; i < n; ++i) {
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t j = 0; j < n; ++j) {
        if (j != i) nearest = std::min(nearest, Norm(positions[j] - positions[i]));
      }
      EXPECT_DOUBLE_EQ(distances[i], nearest);
    }
  }
  EXPECT_TRUE(NearestNeighbourDistances(std::vector<Vec3d>{{1, 2, 3}}).empty());
}

TEST(FlockStatistics, FrameByFrame) {
  // Three animals at x = 0, 1, 3 in frame 1; the last one alone in frame 4.
  Trajectories flock;
  flock.trajectories = {{1, {At(1, {0, 0, 0}, {2, 0, 0})}},
                        {2, {At(1, {1, 0, 0}, {4, 0, 0})}},
                        {3, {At(1, {3, 0, 0}, {6, 0, 0}), At(4, {9, 0, 0}, {0, 0, 0})}}};
  EXPECT_THROW(StatesByFrame{flock}, std::invalid_argument);  // no velocities
  flock.has_velocity = true;
  const StatesByFrame states(flock);
  const std::vector<FlockStatistics> all = ComputeFlockStatistics(states);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].count, 3);
  EXPECT_DOUBLE_EQ(*all[0].polarisation, 1);
  EXPECT_DOUBLE_EQ(all[0].speed_median, 4);
  EXPECT_DOUBLE_EQ(all[0].speed_low, 2.4);
  EXPECT_DOUBLE_EQ(*all[0].neighbour_median, 1);  // 1, 1, 2
  EXPECT_DOUBLE_EQ(*all[0].neighbour_high, 1.8);
  EXPECT_EQ(all[1].frame, 4);
  EXPECT_EQ(all[1].count, 1);
  EXPECT_FALSE(all[1].polarisation.has_value());
  EXPECT_FALSE(all[1].neighbour_median.has_value());
  EXPECT_EQ(ComputeFlockStatistics(states, 2).size(), 1u);
}

TEST(FlockStatistics, StepsShowWhereAPathJumps) {
  // 1 m a frame at 10 frames/s for 20 frames, a gap of 2 frames crossed at the same speed, and one
  // jump of 5 m.
  Trajectory trajectory{1, {}};
  double x = 0;
  for (int frame = 1; frame <= 23; ++frame) {
    x += frame == 12 ? 5 : 1;
    if (frame == 20 || frame == 21) continue;
    trajectory.points.push_back(At(frame, {x, 0, 0}, {}));
  }
  Trajectories flock;
  flock.trajectories = {trajectory};
  const StepStatistics steps = ComputeSteps(flock, 10);
  EXPECT_EQ(steps.steps, 20u);
  EXPECT_DOUBLE_EQ(steps.median, 10);
  EXPECT_DOUBLE_EQ(steps.largest, 50);
  EXPECT_EQ(steps.jumps, 1u);
  EXPECT_EQ(ComputeSteps({}, 10).steps, 0u);
  EXPECT_THROW(ComputeSteps(flock, 0), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
