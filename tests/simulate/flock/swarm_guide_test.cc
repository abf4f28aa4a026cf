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

}  // namespace
}  // namespace flocklift
