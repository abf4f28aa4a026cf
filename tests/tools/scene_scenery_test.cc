// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/scene_scenery.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace flocklift {
namespace {

Obstacle Triangle() {
  Obstacle obstacle;
  obstacle.mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  return obstacle;
}

TEST(SceneSceneryTest, ShowsWhatTheSwitchesSay) {
  Scene scene;
  scene.goals.push_back({.species = {}, .position = {1, 2, 3}, .reach = 2});
  scene.paths.push_back({.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}});
  const std::vector<Obstacle> obstacles{Triangle()};
  const auto count = [&](auto member) {
    scene.render.obstacles = scene.render.goals = scene.render.paths = scene.render.ground = false;
    scene.render.*member = true;
    int surfaces = 0, strokes = 0, balls = 0;
    SceneScenery(scene, obstacles).With(1, 0, [&](const Setting& setting) {
      surfaces = static_cast<int>(setting.surfaces.size());
      strokes = static_cast<int>(setting.strokes.size());
      balls = static_cast<int>(setting.balls.size());
    });
    return std::vector<int>{surfaces, strokes, balls};
  };
  EXPECT_EQ(count(&RenderSpec::obstacles), (std::vector<int>{1, 0, 0}));
  EXPECT_EQ(count(&RenderSpec::goals), (std::vector<int>{0, 1, 1}));
  EXPECT_EQ(count(&RenderSpec::paths), (std::vector<int>{0, 1, 0}));
  EXPECT_EQ(count(&RenderSpec::ground), (std::vector<int>{0, 2 * 41, 0}));
}

TEST(SceneSceneryTest, GoalsFollowTheirMotionAndTheEvents) {
  Scene scene;
  scene.render.goals = true;
  scene.goals.push_back(
      {.species = {}, .position = {1, 0, 3}, .radius = 4, .period = 8, .reach = 2});
  scene.goals.push_back({.species = {}, .position = {5, 5, 5}});
  scene.events.push_back(
      {.time = 3, .species = {}, .change = {}, .goal = 1, .position = {9, 9, 9}, .wind = {}});
  const Scenery scenery = SceneScenery(scene, {});
  const auto at = [&](double time) {
    std::vector<TintedBall> balls;
    scenery.With(1, time, [&](const Setting& setting) {
      balls.assign(setting.balls.begin(), setting.balls.end());
    });
    return balls;
  };
  EXPECT_NEAR(Norm(at(0)[0].center - Vec3d{5, 0, 3}), 0, 1e-9);
  EXPECT_NEAR(Norm(at(2)[0].center - Vec3d{1, 4, 3}), 0, 1e-9);
  EXPECT_EQ(at(2)[0].radius, 2);
  EXPECT_NEAR(Norm(at(4)[1].center - Vec3d{5, 5, 5}), 0, 1e-9);
  EXPECT_NEAR(at(0)[1].radius, 0.02 * Norm(Vec3d{40, 40, 20}), 1e-9);
  EXPECT_GT(Norm(at(4)[0].center - at(2)[0].center), 1);
}

TEST(SceneSceneryTest, APathGoesFromItsFirstPointToItsLast) {
  Scene scene;
  scene.render.paths = true;
  const std::vector<Vec3d> points{{0, 0, 1}, {4, 0, 1}, {4, 6, 2}, {9, 6, 5}};
  scene.paths.push_back({.points = points});
  SceneScenery(scene, {}).With(1, 0, [&](const Setting& setting) {
    const std::vector<Vec3d>& curve = setting.strokes[0].points;
    EXPECT_NEAR(Norm(curve.front() - points.front()), 0, 1e-12);
    EXPECT_NEAR(Norm(curve.back() - points.back()), 0, 1e-12);
    for (std::size_t k = 2; k < curve.size(); ++k) {  // no corner
      const Vec3d before = Normalized(curve[k - 1] - curve[k - 2]);
      EXPECT_GT(Dot(before, Normalized(curve[k] - curve[k - 1])), 0.98) << k;
    }
  });
}

}  // namespace
}  // namespace flocklift
