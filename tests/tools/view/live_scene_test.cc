// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/live_scene.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "simulate/core/check.h"
#include "simulate/core/scene_io.h"
#include "simulate/flock/engine.h"
#include "simulate/flock/population.h"
#include "tools/view/scene_view.h"

namespace flocklift {
namespace {

Scene SmallScene() {
  return ParseScene(R"(
[scene]
seed = 3
duration = 5
fps = 60
substeps = 1
box = [[-20, -20, 0], [20, 20, 20]]
[[species]]
name = "bird"
count = 40
speed = 8
model = "boids"
[[predator]]
)",
                    "test");
}

struct Snapshot {
  std::uint32_t agents = 0, goals = 0;
  float time = 0;
  std::vector<float> goal, position;
};

Snapshot Next(LiveScene* live, std::uint64_t* seen) {
  std::shared_ptr<const std::string> look;
  while (!(look = live->Look(seen))) {
  }
  Snapshot s;
  std::uint32_t header[4];
  std::memcpy(header, look->data(), sizeof header);
  EXPECT_EQ(look->substr(0, 4), "FLKS");
  s.agents = header[1];
  s.goals = header[2];
  std::memcpy(&s.time, look->data() + 16, 4);
  s.goal.resize(3 * s.goals);
  s.position.resize(3 * s.agents);
  std::memcpy(s.goal.data(), look->data() + 32, 4 * s.goal.size());
  std::memcpy(s.position.data(), look->data() + 32 + 4 * s.goal.size(), 4 * s.position.size());
  const std::size_t velocities = (3 * s.agents + 1) / 2 * 4;
  EXPECT_EQ(look->size(), 32 + 4 * (s.goal.size() + s.position.size()) + velocities);
  return s;
}

double MeanDistance(const Snapshot& s, const Vec3d& to, std::size_t animals) {
  double sum = 0;
  for (std::size_t k = 0; k < animals; ++k) {
    sum += Norm(Vec3d{s.position[3 * k], s.position[3 * k + 1], s.position[3 * k + 2]} - to);
  }
  return sum / static_cast<double>(animals);
}

std::vector<float> Floats(const std::vector<Vec3d>& points) {
  std::vector<float> floats;
  for (const Vec3d& p : points) {
    for (const double x : {p.x, p.y, p.z}) floats.push_back(static_cast<float>(x));
  }
  return floats;
}

TEST(LiveScene, RunsPausesStepsAndResets) {
  LiveScene live(SmallScene(), 1);
  std::uint64_t seen = 0;
  Snapshot s = Next(&live, &seen);
  EXPECT_EQ(s.agents, 41u);
  while (s.time < 0.1) s = Next(&live, &seen);
  live.Pause(true);
  const Snapshot before = Next(&live, &seen);
  live.StepOnce();
  s = Next(&live, &seen);
  while (s.time == before.time) s = Next(&live, &seen);
  EXPECT_NEAR(s.time - before.time, 1.0 / 60, 1e-5);
  live.Reset();
  s = Next(&live, &seen);
  while (s.time > 0) s = Next(&live, &seen);
  const Population start = Populate(SmallScene());
  EXPECT_EQ(s.position, Floats(Engine(start.world, start.swarms, {}).State().position));
}

TEST(LiveScene, AClickAttractsTheFlock) {
  LiveScene live(SmallScene(), 1);
  live.SetPace(20);
  const Vec3d point{12, 12, 15};
  std::uint64_t seen = 0;
  const Snapshot before = Next(&live, &seen);
  live.Attract(point, 3);
  Snapshot s = before;
  while (s.time < before.time + 8) s = Next(&live, &seen);
  ASSERT_EQ(s.goals, 1u);
  EXPECT_EQ(s.goal, (std::vector<float>{12, 12, 15}));
  EXPECT_LT(MeanDistance(s, point, 40), 0.6 * MeanDistance(before, point, 40));
  live.Attract(std::nullopt, 3);
  EXPECT_TRUE(live.Current().goals.empty());
}

TEST(LiveScene, ParametersGoalsPredatorsAndWindAreKept) {
  LiveScene live(SmallScene(), 1);
  live.Pause(true);
  ModelSpec change;
  change.parameters["alpha_a"] = 0.25;
  ModelSpec wrong;
  wrong.parameters["k_x"] = 1;
  EXPECT_THROW(live.SetParameter("bird", wrong), InputError);
  EXPECT_THROW(live.SetParameter("fish", change), std::invalid_argument);
  EXPECT_THROW(live.MoveGoal(0, {1, 2, 3}), std::invalid_argument);
  EXPECT_THROW(live.MovePredator(1, {1, 2, 3}), std::invalid_argument);
  live.Attract(Vec3d{1, 2, 3}, 2);
  live.MoveGoal(0, {4, 5, 6});
  live.SetWind({1, 0, 0});
  live.MovePredator(0, {7, 8, 9});
  std::uint64_t seen = 0;
  Snapshot s = Next(&live, &seen);
  while (s.position[3 * 40] != 7) s = Next(&live, &seen);
  EXPECT_EQ(s.position[3 * 40 + 2], 9);
  // What is saved reads back as it is.
  const Scene now = ParseScene(FormatScene(live.Current()), "saved");
  ASSERT_EQ(now.goals.size(), 1u);
  EXPECT_EQ(now.goals[0].position, (Vec3d{4, 5, 6}));
  EXPECT_EQ(now.wind.velocity, (Vec3d{1, 0, 0}));
}

TEST(LiveScene, AWayLeadsAGoalAlong) {
  LiveScene live(SmallScene(), 1);
  live.SetPace(20);
  live.Lead({{-10, 0, 5}, {10, 0, 5}}, 2, 1);
  std::uint64_t seen = 0;
  Snapshot s = Next(&live, &seen);
  const float start = s.time;
  while (s.time < start + 3) s = Next(&live, &seen);
  EXPECT_NEAR(s.goal[0], 10, 1e-4);
  EXPECT_EQ(live.Current().goals.at(0).waypoints.size(), 24u);
}

TEST(LiveScene, AClickMovesTheGoalOfASwarm) {
  LiveScene live(ParseScene(R"(
[scene]
seed = 5
duration = 5
fps = 30
box = [[-5, -5, 0], [5, 5, 10]]
[[species]]
name = "moth"
count = 10
speed = 2
model = "swarm"
[[goal]]
position = [0, 0, 5]
reach = 0.5
)",
                            "test"),
                 1);
  live.SetPace(20);
  std::uint64_t seen = 0;
  const Snapshot before = Next(&live, &seen);
  const Vec3d point{4, 4, 9};
  live.Attract(point, 3);
  Snapshot s = before;
  while (s.time < before.time + 8) s = Next(&live, &seen);
  ASSERT_EQ(s.goals, 1u);
  EXPECT_EQ(s.goal, (std::vector<float>{4, 4, 9}));
  EXPECT_LT(MeanDistance(s, point, 10), 0.6 * MeanDistance(before, point, 10));
  // So does a way, and a click after it.
  live.Lead({{4, 4, 9}, {-4, -4, 1}}, 1, 3);
  EXPECT_EQ(live.Current().goals.at(0).waypoints.size(), 24u);
  live.Attract(point, 3);
  EXPECT_TRUE(live.Current().goals.at(0).waypoints.empty());
  EXPECT_EQ(live.Current().goals.at(0).position, point);
}

TEST(LiveScene, WhatGoesToShapesIsNotAttracted) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "live_scene_morph";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "one.ply") << "ply\nformat ascii 1.0\nelement vertex 4\n"
                                       "property float x\nproperty float y\nproperty float z\n"
                                       "element face 4\nproperty list uchar int vertex_indices\n"
                                       "end_header\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n"
                                       "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  std::ofstream(folder / "scene.toml") << R"(
[scene]
duration = 5
box = [[-20, -20, -5], [20, 20, 20]]
[[species]]
name = "t"
count = 400
wingspan = 0.2
body_length = 0.2
model = "morph"
start = "one"
shape = "two"
[[shape]]
name = "two"
mesh = "one.ply"
position = [10, 0, 0]
[[shape]]
name = "one"
mesh = "one.ply"
)";
  LiveScene live(ReadScene(folder / "scene.toml"), 1);
  EXPECT_THROW(live.Attract(Vec3d{1, 2, 3}, 1), std::invalid_argument);
  EXPECT_TRUE(live.Current().goals.empty());
  EXPECT_NO_THROW(live.Attract(std::nullopt, 1));
}

TEST(LiveScene, ALineBecomesTheNearestPath) {
  LiveScene live(ParseScene(R"(
[scene]
seed = 5
duration = 5
fps = 30
box = [[-20, -20, 0], [20, 20, 20]]
[[species]]
name = "bird"
count = 10
speed = 8
model = "boids"
[[path]]
name = "left"
points = [[-10, 0, 5], [-10, 10, 5]]
[[path]]
name = "right"
points = [[10, 0, 5], [10, 10, 5]]
)",
                            "test"),
                 1);
  std::uint64_t seen = 0;
  Snapshot s = Next(&live, &seen);
  while (s.time < 0.1) s = Next(&live, &seen);
  live.Pause(true);
  live.Guide({{9, 0, 5}, {9, 0, 15}, {19, 0, 15}});
  const std::vector<PathSpec> paths = ParseScene(FormatScene(live.Current()), "saved").paths;
  ASSERT_EQ(paths.size(), 2u);
  EXPECT_EQ(paths[0].points, (std::vector<Vec3d>{{-10, 0, 5}, {-10, 10, 5}}));
  ASSERT_EQ(paths[1].points.size(), 12u);
  EXPECT_EQ(paths[1].points.front(), (Vec3d{9, 0, 5}));
  EXPECT_EQ(paths[1].points.back(), (Vec3d{19, 0, 15}));
  for (std::size_t k = 1; k < 12; ++k) {  // evenly, but where the corner is cut
    EXPECT_LE(Norm(paths[1].points[k] - paths[1].points[k - 1]), 20.0 / 11 + 1e-9);
  }
  s = Next(&live, &seen);
  while (s.time > 0) s = Next(&live, &seen);  // anew
  EXPECT_THROW(live.Guide({{1, 2, 3}}), std::invalid_argument);
  EXPECT_THROW(live.Guide({{1, 2, 3}, {1, 2, 3}}), std::invalid_argument);
  EXPECT_EQ(live.Current().paths[1].points, paths[1].points);
  LiveScene without(SmallScene(), 1);
  EXPECT_THROW(without.Guide({{0, 0, 0}, {1, 0, 0}}), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
