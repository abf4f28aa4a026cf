// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/radius_choice.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "reconstruct/fit/window_choice.h"
#include "simulate/flock/model.h"
#include "tests/reconstruct/fit/flocks.h"

namespace flocklift {
namespace {

// Birds that wheel about a point, by radii and an edge that are not the model's.
Scene CirclingScene(std::uint64_t seed) {
  Scene scene;
  scene.seed = seed;
  scene.warmup = 15;
  scene.box = {{-100, -100, 0}, {100, 100, 100}};
  SpeciesSpec& birds = scene.species.emplace_back();
  birds.count = 20;
  birds.start = Region{{-12, -12, 8}, {12, 12, 16}};
  birds.model.parameters = {{"d_s", 4},   {"d_v", 12},    {"taper", 3},      {"alpha_s", 1.5},
                            {"noise", 1}, {"level", 0.8}, {"goal_range", 20}};
  GoalSpec goal;
  goal.position = {0, 0, 12};
  goal.weight = 0.6;
  scene.goals = {goal};
  return scene;
}

Trajectories Positions(const Scene& scene) {
  Trajectories flock = Fly(scene);
  flock.has_velocity = false;
  return flock;
}

TEST(RadiusChoice, AFlockFliesOnBetterByTheRadiiChosen) {
  for (const std::uint64_t seed : {1, 5}) {
    const Scene scene = CirclingScene(seed);
    const Trajectories flock = Positions(scene);
    const auto fit = [&](bool chosen) {
      FitProblem problem;
      problem.model.name = "boids";
      if (!chosen) {
        for (const char* name : {"d_s", "d_v", "taper"}) {
          problem.model.parameters[name] =
              CompleteModel({.name = "boids", .parameters = {}, .where = {}, .where_of = {}})
                  .parameters.at(name);
        }
      }
      return FitModel({}, problem, flock, scene.fps, 1, 2);
    };
    const FitResult by_model = fit(false), by_choice = fit(true);
    const auto error = [&](const FitResult& result) {
      return internal::FlyOn(result.parameters, flock, scene.fps, 4, 1).model;
    };
    EXPECT_LT(error(by_choice), 0.9 * error(by_model)) << seed;
    EXPECT_GT(by_choice.r2_held_out.value(), by_model.r2_held_out.value()) << seed;
    EXPECT_NEAR(by_choice.parameters.model.parameters.at("d_s"), 4, 0.6) << seed;
    EXPECT_GT(by_choice.parameters.model.parameters.at("taper"), 1.5) << seed;
    EXPECT_NE(by_choice.warnings.front().find("d_s is"), std::string::npos);
  }
}

TEST(RadiusChoice, LeavesWhatIsGiven) {
  const Scene scene = CirclingScene(1);
  FitProblem problem;
  problem.model.name = "boids";
  problem.model.parameters["d_v"] = 12;
  std::vector<std::string> notes;
  const FitProblem same =
      internal::ChooseRadii({}, problem, Positions(scene), scene.fps, 1, 2, &notes);
  EXPECT_EQ(same.model.parameters, problem.model.parameters);
  problem.model = {.name = "linear", .parameters = {}, .where = {}, .where_of = {}};
  EXPECT_TRUE(internal::ChooseRadii({}, problem, Positions(scene), scene.fps, 1, 2, &notes)
                  .model.parameters.empty());
  EXPECT_TRUE(notes.empty());
}

}  // namespace
}  // namespace flocklift
