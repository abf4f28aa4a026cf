// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/observed_flock.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flocklift {
namespace {

constexpr double kFps = 10;

// x = (t, t^2, 1) in the frames asked for.
Trajectory Parabola(Id id, std::vector<int> frames) {
  Trajectory trajectory{.id = id, .points = {}};
  for (const int frame : frames) {
    const double t = frame / kFps;
    TrajectoryPoint point;
    point.frame = frame;
    point.position = {t, t * t, 1};
    trajectory.points.push_back(point);
  }
  return trajectory;
}

TEST(ObservedFlock, BetweenIsExactOnAParabola) {
  Trajectories flock;
  flock.trajectories = {Parabola(4, {1, 2, 3, 4, 5})};
  const ObservedFlock observed(flock, kFps, 0);
  for (int part = 0; part < 4; ++part) {
    const auto state = observed.Between(3, part, 4, 0);
    ASSERT_EQ(state.animal.size(), 1U);
    const double t = 0.3 + 0.025 * part;
    EXPECT_NEAR(state.position[0].y, t * t, 1e-12);
    EXPECT_NEAR(state.velocity[0].x, 1, 1e-12);
    EXPECT_NEAR(state.velocity[0].y, 2 * t, 1e-12);
    // An engine of step h has v_n = (x_n - x_{n-1}) / h, half a step of acceleration 2 behind.
    EXPECT_NEAR(observed.Between(3, part, 4, 0.25).velocity[0].y, 2 * t - 0.025, 1e-12);
  }
  EXPECT_NEAR(observed.Between(3, 0, 1, 1).velocity[0].y, (0.09 - 0.04) * kFps, 1e-12);
}

TEST(ObservedFlock, ForeseenKnowsNothingOfLaterFrames) {
  Trajectories flock;
  flock.trajectories = {Parabola(1, {1, 2, 3, 4, 5, 6, 7, 8})};
  const auto before = ObservedFlock(flock, kFps, 0).Foreseen(5, 3, 2);
  for (std::size_t k = 5; k < 8; ++k) flock.trajectories[0].points[k].position = {};
  const auto after = ObservedFlock(flock, kFps, 0).Foreseen(5, 3, 2);
  EXPECT_EQ(before.position[0], after.position[0]);
  EXPECT_EQ(before.velocity[0], after.velocity[0]);
  EXPECT_NEAR(before.position[0].x, 0.7, 1e-12);
  EXPECT_NEAR(before.position[0].y, 0.49, 1e-12);
  EXPECT_NEAR(before.velocity[0].y, 1.4, 1e-12);
}

TEST(ObservedFlock, BridgesShortGapsAndKeepsLongOnes) {
  Trajectories flock;
  flock.trajectories = {Parabola(1, {1, 2, 3, 6, 7, 8}), Parabola(2, {1, 2, 7, 8})};
  const ObservedFlock observed(flock, kFps, 2);
  EXPECT_TRUE(observed.Has(0, 4));
  EXPECT_FALSE(observed.Measured(0, 4));
  EXPECT_TRUE(observed.Measured(0, 3));
  EXPECT_NEAR(observed.Position(0, 4).x, 0.4, 1e-12);
  EXPECT_NEAR(observed.Position(0, 4).y, 0.16, 1e-12);
  EXPECT_FALSE(observed.Has(1, 4));
  const auto state = observed.Between(4, 0, 4, 0);
  ASSERT_EQ(state.animal.size(), 1U);
  EXPECT_EQ(state.Find(0), 0);
  EXPECT_EQ(state.Find(1), -1);
  // One-sided at the end of a run.
  EXPECT_NEAR(observed.Between(2, 0, 4, 0).velocity[1].y, (0.04 - 0.01) * kFps, 1e-12);
}

TEST(ObservedFlock, AnimalsComeAndGo) {
  Trajectories flock;
  flock.trajectories = {Parabola(3, {5, 6, 7}), Parabola(9, {7, 8, 9}), Parabola(12, {20})};
  const ObservedFlock observed(flock, kFps, 2);
  EXPECT_EQ(observed.span().first, 5);
  EXPECT_EQ(observed.span().last, 20);
  EXPECT_EQ(observed.Between(7, 0, 4, 0).animal, (std::vector<int>{0, 1}));
  EXPECT_EQ(observed.Between(9, 0, 4, 0).animal, (std::vector<int>{1}));
  EXPECT_TRUE(observed.Between(20, 0, 4, 0).animal.empty());  // one row has no velocity
  EXPECT_TRUE(observed.Between(40, 0, 4, 0).animal.empty());
  EXPECT_TRUE(ObservedFlock(Trajectories{}, kFps, 2).Between(1, 0, 4, 0).animal.empty());
}

}  // namespace
}  // namespace flocklift
