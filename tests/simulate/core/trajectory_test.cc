// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/trajectory.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace flocklift {
namespace {

Trajectory AtFrames(Id id, std::initializer_list<int> frames) {
  Trajectory trajectory{.id = id, .points = {}};
  for (const int frame : frames) {
    TrajectoryPoint point;
    point.frame = frame;
    // A parabola in x, a line in y.
    point.position = {0.5 * frame * frame, 2.0 * frame, -1};
    trajectory.points.push_back(point);
  }
  return trajectory;
}

TEST(ComputeVelocities, CentralInsideOneSidedAtEnds) {
  Trajectories flock;
  flock.trajectories = {AtFrames(1, {1, 2, 3}), AtFrames(2, {5})};
  ComputeVelocities(10, &flock);
  EXPECT_TRUE(flock.has_velocity);
  const auto& points = flock.trajectories[0].points;
  EXPECT_EQ(points[0].velocity, (Vec3d{15, 20, 0}));  // (2 - 0.5) a frame, ten frames a second
  EXPECT_EQ(points[1].velocity, (Vec3d{20, 20, 0}));  // the parabola's own slope
  EXPECT_EQ(points[2].velocity, (Vec3d{25, 20, 0}));
  EXPECT_EQ(flock.trajectories[1].points[0].velocity, Vec3d{});
}

TEST(ComputeVelocities, SpansGaps) {
  Trajectories flock;
  flock.trajectories = {AtFrames(1, {1, 2, 6})};
  ComputeVelocities(10, &flock);
  const auto& points = flock.trajectories[0].points;
  EXPECT_DOUBLE_EQ(points[1].velocity.x, (18 - 0.5) / 5 * 10);
  EXPECT_DOUBLE_EQ(points[2].velocity.x, (18 - 2.0) / 4 * 10);
}

TEST(ComputeVelocities, NeedsTime) {
  Trajectories flock;
  EXPECT_THROW(ComputeVelocities(0, &flock), std::invalid_argument);
  EXPECT_THROW(ComputeVelocities(-1, &flock), std::invalid_argument);
}

TEST(StateAtFrame, HoldsWhoIsThere) {
  Trajectories flock;
  flock.trajectories = {AtFrames(3, {1, 2, 4}), AtFrames(7, {2, 3}), AtFrames(9, {})};
  ComputeVelocities(1, &flock);
  const FlockState state = StateAtFrame(flock, 2);
  EXPECT_EQ(state.id, (std::vector<Id>{3, 7}));
  EXPECT_EQ(state.position[0], (Vec3d{2, 4, -1}));
  EXPECT_EQ(state.velocity[1], flock.trajectories[1].points[0].velocity);
  EXPECT_EQ(StateAtFrame(flock, 3).id, std::vector<Id>{7});
  EXPECT_EQ(StateAtFrame(flock, 5).size(), 0u);
}

TEST(SpanOf, IsFromTheFirstToTheLastOfAny) {
  Trajectories flock;
  EXPECT_EQ(SpanOf(flock).first, 0);
  EXPECT_EQ(SpanOf(flock).last, -1);
  flock.trajectories = {AtFrames(3, {5, 9}), AtFrames(7, {2, 3}), AtFrames(9, {})};
  EXPECT_EQ(SpanOf(flock).first, 2);
  EXPECT_EQ(SpanOf(flock).last, 9);
  Tracks tracks;
  tracks.tracklets.push_back({1, std::vector<Detection>(2)});
  tracks.tracklets[0].detections[0].frame = 4;
  tracks.tracklets[0].detections[1].frame = 6;
  EXPECT_EQ(SpanOf(tracks).first, 4);
  EXPECT_EQ(SpanOf(tracks).last, 6);
}

}  // namespace
}  // namespace flocklift
