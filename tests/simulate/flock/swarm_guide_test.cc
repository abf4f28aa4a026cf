// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/swarm_guide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/flock/swarm_velocity.h"

namespace flocklift {
namespace {

World Room() {
  World world;
  world.box = {{0, 0, 0}, {12, 6, 4}};
  world.obstacles.push_back({{}, Block{{5, 0, 0}, {6, 4, 3}}});
  return world;
}

std::vector<GoalSpec> GoalAt(const Vec3d& position) {
  GoalSpec goal;
  goal.position = position;
  goal.reach = 0.4;
  return {goal};
}

template <typename T>
void ExpectTheFreshGuide() {
  const World room = Room();
  GuideField kept(room, 0.25, {}, GoalAt({10, 3, 2}), 1);
  Bodies<T> animals;
  animals.Resize(40);
  Rng rng(3);
  for (int move = 0; move < 6; ++move) {
    const Vec3d at{10 - 1.5 * move, 3 + 0.3 * move, 2};
    kept.SetGoals(GoalAt(at));
    const GuideField fresh(room, 0.25, {}, GoalAt(at), 1);
    for (int look = 0; look < 3; ++look) {
      for (std::size_t k = 0; k < animals.size(); ++k) {
        // Some are beyond the box.
        animals.Set(
            k, {T(rng.Uniform(-0.5, 12.5)), T(rng.Uniform(-0.5, 6.5)), T(rng.Uniform(0, 4))}, {});
      }
      kept.Cover(animals);
      for (std::size_t k = 0; k < animals.size(); ++k) {
        const GuideSample<T> a = SampleGuide<T>(kept.View(1), animals.Position(k));
        const GuideSample<T> b = SampleGuide<T>(fresh.View(1), animals.Position(k));
        ASSERT_EQ(a.velocity, b.velocity) << move << ' ' << k;
        ASSERT_EQ(a.distance, b.distance);
      }
    }
  }
}

TEST(GuideField, AMovedGoalGivesTheFreshGuideWhereAnimalsAre) {
  ExpectTheFreshGuide<float>();
  ExpectTheFreshGuide<double>();
}

TEST(GuideField, LeadsToTheGoalWithTheSpeedAskedFor) {
  const GuideField guide(Room(), 0.25, {}, GoalAt({10, 3, 2}), 1);
  const GuideSample<double> open = SampleGuide<double>(guide.View(2), {8, 3, 2});
  EXPECT_NEAR(open.velocity.x, 2, 0.1);
  EXPECT_EQ(open.distance, guide.WallReach());  // farther than is told
  // Behind the block the way is round it or over it, not through.
  const GuideSample<double> behind = SampleGuide<double>(guide.View(2), {4.6, 1, 1});
  EXPECT_LT(behind.velocity.x, 1);
  EXPECT_NEAR(behind.distance, 0.4, 0.05);
}

// In a wide room the way is straight; a front that marches through a grid bends it.
TEST(GuideField, PointsStraightAtAGoalInPlainSight) {
  World hall;
  hall.box = {{0, 0, 0}, {30, 20, 12}};
  const Vec3d goal{21, 13, 5};
  const GuideField guide(hall, 0.25, {}, GoalAt(goal), 1);
  Rng rng(6);
  for (int k = 0; k < 500; ++k) {
    const Vec3d at{rng.Uniform(2, 28), rng.Uniform(2, 18), rng.Uniform(2, 10)};
    if (Norm(goal - at) < 1.5) continue;
    const Vec3d way = SampleGuide<double>(guide.View(1), at).velocity;
    // A part is told in 127ths.
    EXPECT_LT(Norm(way - Normalized(goal - at)), 0.02) << k;
  }
}

// What is in sight of a goal through a window needs no march; what is not does, and both agree on
// where to go.
TEST(GuideField, WhoFollowsItArrivesFromBehindAWall) {
  World world;
  world.box = {{0, 0, 0}, {16, 10, 8}};
  world.obstacles.push_back({{}, Block{{8, 0, 0}, {9, 10, 3}}});
  world.obstacles.push_back({{}, Block{{8, 0, 6}, {9, 10, 8}}});
  const std::vector<GoalSpec> goals = GoalAt({14, 5, 2});
  const GuideField guide(world, 0.25, {}, goals, 1);
  Rng rng(7);
  for (int k = 0; k < 200; ++k) {
    Vec3d at{rng.Uniform(0.1, 7.9), rng.Uniform(0.1, 9.9), rng.Uniform(0.1, 7.9)};
    int steps = 0;
    while (Norm(at - goals[0].position) > goals[0].reach && steps < 1000) {
      at += 0.05 * SampleGuide<double>(guide.View(1), at).velocity;
      ++steps;
    }
    EXPECT_LT(steps, 600) << k;  // 30 m
  }
}

}  // namespace
}  // namespace flocklift
