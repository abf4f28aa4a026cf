// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Models that fly to what a scene holds, fitted by statistics within that scene: flown with known
// numbers, fitted from others.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "reconstruct/fit/engine_flight.h"
#include "reconstruct/fit/goal_groups.h"
#include "reconstruct/fit/target_distance.h"
#include "simulate/core/check.h"
#include "tests/reconstruct/fit/scene_flocks.h"

namespace flocklift {
namespace {

using internal::FlightStart;

FitOptions FewEvaluations() {
  FitOptions options;
  options.statistics_time = 3;
  options.global_evaluations = 60;
  options.local_evaluations = 60;
  return options;
}

// Each within 3 of its own sd of the truth, or open.
void ExpectTruthOrOpen(const FitResult& fit, const Scene& scene) {
  ASSERT_TRUE(fit.IsUsable());
  EXPECT_EQ(fit.method, FitMethod::kStatistics);
  ASSERT_EQ(fit.misfit.size(), kMotionStatistics.size());
  const ModelSpec truth = CompleteModel(scene.species[0].model);
  for (const FittedWeight& weight : fit.weights) {
    if (!weight.determined) continue;
    EXPECT_LT(std::abs(std::log(weight.value / truth.parameters.at(weight.name))),
              3 * weight.sd / weight.value)
        << weight.name << " " << weight.value;
  }
}

TEST(SceneFit, FindsTheShareOfAShapeSwarmsOwnForces) {
  const Scene scene = ShapeScene();
  FitProblem problem = ProblemOf(scene);
  problem.free = {"alpha", "s_max"};
  problem.model.parameters["alpha"] = 0.85;
  problem.model.parameters["s_max"] = 0.8;
  problem.search = SimulatedSearch::kBobyqa;
  const FitResult fit = FitModel(FewEvaluations(), problem, Fly(scene), scene.fps, 1, 2);
  ExpectTruthOrOpen(fit, scene);
  EXPECT_TRUE(fit.weights[0].determined) << fit.weights[0].sd;
}

TEST(SceneFit, FindsTheSpeedOfACrowd) {
  const Scene scene = CrowdScene();
  FitProblem problem = ProblemOf(scene);
  problem.free = {"f_max", "gamma"};
  problem.model.parameters["f_max"] = 1.1;
  problem.search = SimulatedSearch::kBobyqa;
  const Trajectories flock = Fly(scene);
  FitOptions options = FewEvaluations();
  options.local_evaluations = 150;  // its sd is small: the search has to come as near
  const FitResult fit = FitModel(options, problem, flock, scene.fps, 1, 2);
  ExpectTruthOrOpen(fit, scene);
  EXPECT_TRUE(fit.weights[0].determined) << fit.weights[0].sd;
  const FitResult again = FitModel(options, problem, flock, scene.fps, 1, 1);
  EXPECT_EQ(fit.weights[0].value, again.weights[0].value);
  EXPECT_EQ(fit.weights[0].sd, again.weights[0].sd);
}

TEST(SceneFit, FindsSpeedAndDepartureOfAMorph) {
  const Scene scene = MorphScene();
  FitProblem problem = ProblemOf(scene);
  problem.free = {"speed0", "departure_time"};
  problem.model.parameters["speed0"] = 6;
  problem.model.parameters["departure_time"] = 3;
  problem.search = SimulatedSearch::kBobyqa;
  const FitResult fit = FitModel(FewEvaluations(), problem, Fly(scene), scene.fps, 1, 2);
  ExpectTruthOrOpen(fit, scene);
  EXPECT_TRUE(fit.weights[0].determined) << fit.weights[0].sd;
  EXPECT_TRUE(fit.weights[1].determined) << fit.weights[1].sd;
}

TEST(SceneFit, NeedsTheSceneAndNothingButStatistics) {
  const Scene scene = ShapeScene();
  const Trajectories flock = Fly(scene);
  FitProblem problem = ProblemOf(scene);
  problem.scene.reset();
  EXPECT_THROW(FitModel({}, problem, flock, scene.fps, 1, 1), InputError);
  problem = ProblemOf(CrowdScene());
  problem.model = scene.species[0].model;  // nobody there moves by it
  EXPECT_THROW(FitModel({}, problem, flock, scene.fps, 1, 1), InputError);
  problem = ProblemOf(scene);
  problem.model = {.name = "boids", .parameters = {}, .where = {}, .where_of = {}};
  EXPECT_THROW(FitModel({}, problem, flock, scene.fps, 1, 1), InputError);
}

// Flights from the data's frame and the scene's start are where the scene's own animals are.
TEST(EngineFlight, ATetrahedronIsWhereTheSceneSaysItIs) {
  const Scene scene = MorphScene();
  const Trajectories flock = Fly(scene);
  Trajectories late = flock;
  for (Trajectory& path : late.trajectories)
    path.points.erase(path.points.begin(), path.points.begin() + 20);
  std::vector<FramePositions> frames(40);
  const FitProblem problem = ProblemOf(scene);
  const FlightStart start = internal::MakeFlightStart({}, problem, frames, late, scene.fps);
  EXPECT_EQ(start.steps_before, 20);
  const auto flown = internal::Fly(start, problem.model, 1, scene.seed);
  ASSERT_TRUE(flown.has_value());
  ASSERT_EQ(flown->size(), 40U);
  for (std::size_t k = 0; k < flock.trajectories.size(); ++k) {
    EXPECT_EQ((*flown)[5].position[k], flock.trajectories[k].points[25].position) << k;
  }
}

// A search tries all numbers within its box, of which not all go together.
TEST(EngineFlight, IsNoneWhereNumbersDoNotGoTogether) {
  const Scene scene = CrowdScene();
  const Trajectories flock = Fly(scene);
  const FitProblem problem = ProblemOf(scene);
  const FlightStart start =
      internal::MakeFlightStart({}, problem, internal::FramesOf(flock), flock, scene.fps);
  ModelSpec slow = problem.model;
  slow.parameters["f_max"] = 0.5 * slow.parameters["f_min"];
  EXPECT_TRUE(internal::Fly(start, problem.model, 1, 1).has_value());
  EXPECT_FALSE(internal::Fly(start, slow, 1, 1).has_value());
}

TEST(TargetDistance, IsThatToTheShape) {
  const Scene scene = ShapeScene();
  const Trajectories flock = Fly(scene);
  const std::vector<FramePositions> frames(45, {{1}, {{0, 0, 8}}});
  const FlightStart start =
      internal::MakeFlightStart({}, ProblemOf(scene), frames, flock, scene.fps);
  const TargetDistances distances = internal::MakeTargetDistances(start);
  ASSERT_TRUE(distances != nullptr);
  const std::vector<double> far = distances(0, {{0, 0, 1008}, {0, 0, 2008}});
  ASSERT_EQ(far.size(), 2U);
  EXPECT_NEAR(far[1] - far[0], 1000, 1);
}

// Who belongs to which of two goals is told by where they go, whatever their ids.
TEST(GoalGroups, AreToldByWhereAnimalsGo) {
  World world;
  for (const double x : {-10.0, 10.0}) {
    GoalSpec goal;
    goal.position = {x, 0, 0};
    world.goals.push_back(goal);
  }
  std::vector<FramePositions> frames(11);
  const std::vector<Id> ids = {2, 3, 5, 8, 9};
  const std::set<Id> left = {3, 5, 9};
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (const Id id : ids) {
      frames[f].id.push_back(id);
      const double way = 0.2 * static_cast<double>(f) * (left.contains(id) ? -1 : 1);
      frames[f].position.push_back({way, static_cast<double>(id), 0});
    }
  }
  const std::vector<std::size_t> order = OrderByGoal(world, "walker", frames, 0, 10, ids);
  ASSERT_EQ(order.size(), ids.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    EXPECT_EQ(left.contains(ids[order[k]]), k % 2 == 0) << k;
  }
  // The goals change places before the end, and so do the groups.
  for (const double x : {10.0, -10.0}) {
    EventSpec event;
    event.time = 0.5;
    event.goal = x > 0 ? 1 : 2;
    event.position = {x, 0, 0};
    world.events.push_back(event);
  }
  EXPECT_EQ(GoalsAt(world, "walker", 0.4)[0].x, -10);
  EXPECT_EQ(GoalsAt(world, "walker", 0.6)[0].x, 10);
}

}  // namespace
}  // namespace flocklift
