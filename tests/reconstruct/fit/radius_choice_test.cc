// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/radius_choice.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
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

// Where the fit by the model's own radii takes the pull to the goal for noise that lasts, and finds
// no goal, and where the edges are hard, which no radius but the right one has.
TEST(RadiusChoice, FliesOnAsByTheTruth) {
  for (const auto& [seed, taper] : {std::pair{6, 3.0}, std::pair{3, 0.0}}) {
    Scene scene = CirclingScene(static_cast<std::uint64_t>(seed));
    scene.warmup = 20;
    scene.species[0].wingspan_spread = scene.species[0].speed_spread = 0.05;
    scene.species[0].model.parameters.insert_or_assign("taper", taper);
    scene.species[0].model.parameters.insert_or_assign("alpha_c", 0.1);
    scene.species[0].model.parameters.insert_or_assign("alpha_a", 0.7);
    const Trajectories flock = Positions(scene);
    FitProblem problem;
    problem.model.name = "boids";
    Parameters truth;
    truth.model = scene.species[0].model;
    truth.model.name = "boids";
    truth.walls = scene.box;
    truth.goals = scene.goals;
    const auto error = [&](const Parameters& parameters) {
      return internal::FlyOn(parameters, flock, scene.fps, 4, 1).model;
    };
    const FitResult result = FitModel({}, problem, flock, scene.fps, 1, 2);
    EXPECT_EQ(result.parameters.goals.size(), 1U) << seed;
    EXPECT_LT(error(result.parameters), 1.5 * error(truth)) << seed;
  }
}

TEST(RadiusChoice, LeavesWhatIsGiven) {
  const Scene scene = CirclingScene(1);
  FitProblem problem;
  problem.model.name = "boids";
  problem.model.parameters["d_v"] = 12;
  const auto choose = [&] {
    return internal::ChooseRadii({}, problem, Positions(scene), scene.fps, 1, 2);
  };
  EXPECT_EQ(choose().problem.model.parameters, problem.model.parameters);
  EXPECT_TRUE(choose().notes.empty());
  problem.model = {.name = "linear", .parameters = {}, .where = {}, .where_of = {}};
  EXPECT_TRUE(choose().problem.model.parameters.empty());
}

}  // namespace
}  // namespace flocklift
