// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The force terms that a scene adds, as estimators take them apart, against the engine; and flocks
// flown by known ones, fitted from others.

#include "reconstruct/fit/scene_terms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "reconstruct/fit/fit.h"
#include "reconstruct/fit/flock_terms.h"
#include "simulate/core/check.h"
#include "simulate/core/model_terms.h"
#include "simulate/flock/engine.h"
#include "tests/reconstruct/fit/flocks.h"

namespace flocklift {
namespace {

ModelSpec Term(const char* type, const std::map<std::string, double>& parameters) {
  return {.name = type, .parameters = parameters, .where = {}, .where_of = {}};
}

ModelSpec Model(const char* name, std::vector<ModelSpec> terms) {
  ModelSpec model{.name = name, .parameters = {}, .where = {}, .where_of = {}};
  model.terms = std::move(terms);
  return model;
}

// Everything that is a function of the state, once; alignment twice.
std::vector<ModelSpec> AllTerms(double taper) {
  return {Term("separation", {{"gain", 1.5}, {"radius", 2}, {"taper", taper}}),
          Term("cohesion", {{"gain", 0.2}, {"radius", 6}, {"taper", taper}}),
          Term("alignment", {{"gain", 0.7}, {"radius", 3}, {"taper", taper}}),
          Term("alignment", {{"gain", -0.3}, {"radius", 8}, {"taper", taper}}),
          Term("repulsion", {{"gain", 2}, {"radius", 3}, {"taper", taper}, {"exponent", 1.5}}),
          Term("goal", {{"range", 7}}),
          Term("walls", {{"gain", 4}, {"taper", 3}}),
          Term("level", {{"rate", 0.4}}),
          Term("wind", {{"rate", 0.6}}),
          Term("drag", {{"rate", 0.2}}),
          Term("gravity", {{"g", 1.1}})};
}

struct Flock {
  std::vector<Vec3d> x, v;
};

Flock RandomFlock(std::size_t count, std::uint64_t seed) {
  Rng rng(seed, 0);
  Flock flock;
  for (std::size_t k = 0; k < count; ++k) {
    flock.x.push_back({rng.Uniform(-6, 6), rng.Uniform(-6, 6), rng.Uniform(-6, 6)});
    flock.v.push_back({rng.Uniform(-9, 9), rng.Uniform(-9, 9), rng.Uniform(-9, 9)});
  }
  return flock;
}

World Surround(TermSurroundings* around) {
  World world;
  world.dt = 1e-4;
  world.box = {{-5, -5, -5}, {5, 5, 5}};
  world.wind.velocity = {2, -1, 0.5};
  GoalSpec goal;
  goal.position = {3, 0, -2};
  goal.weight = 0.7;
  world.goals = {goal};
  *around = {.walls = world.box, .goals = world.goals, .wind = world.wind.velocity};
  return world;
}

// The engine's own change of velocity in one small step, per second, in double.
std::vector<Vec3d> EngineAccelerations(const World& world, const ModelSpec& model,
                                       const Flock& flock, double cruising_speed) {
  Swarm swarm;
  swarm.species = "tested";
  swarm.model = ResolveModel(model);
  swarm.forces = model.terms;
  swarm.position = flock.x;
  swarm.velocity = flock.v;
  swarm.cruising_speed.assign(flock.x.size(), cruising_speed);
  ReferenceEngine engine(world, {swarm}, {});
  engine.Step();
  const FlockState after = engine.State();
  std::vector<Vec3d> accelerations;
  for (std::size_t k = 0; k < flock.x.size(); ++k) {
    accelerations.push_back((after.velocity[k] - flock.v[k]) / world.dt);
  }
  return accelerations;
}

double Largest(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double largest = 0;
  for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, Norm(a[k] - b[k]));
  return largest;
}

TEST(SceneTerms, AreTheEnginesFreeOrKnown) {
  const Flock flock = RandomFlock(150, 3);
  TermSurroundings around;
  const World world = Surround(&around);
  for (const double taper : {0.0, 0.8}) {
    for (const char* name : {"forces", "boids"}) {
      ModelSpec model = Model(name, AllTerms(taper));
      model.terms.push_back(Term("cruise", {{"rate", 0.9}}));
      model.parameters.insert({{"s_min", 0}, {"s_max", 1e5}});
      if (model.name == "boids") model.parameters["noise"] = 0;
      if (model.name == "boids") model.parameters["cruise"] = 0;
      const ModelSpec complete = CompleteModel(model);
      const std::vector<Vec3d> expected = EngineAccelerations(world, model, flock, 7);
      for (const bool all_free : {false, true}) {
        std::vector<std::string> free;
        if (all_free) free = TermWeights(model);
        const FlockTerms terms = MakeFlockTerms(
            model, free, world.box,
            name == std::string("boids") ? std::optional(world.goals[0]) : std::nullopt, 7, around);
        EXPECT_TRUE(terms.has_own_speed);
        std::vector<Vec3d> columns(flock.x.size() * terms.columns());
        terms.evaluate(flock.x, flock.v, columns);
        std::vector<Vec3d> actual;
        for (std::size_t k = 0; k < flock.x.size(); ++k) {
          const Vec3d* const row = &columns[k * terms.columns()];
          Vec3d a = row[free.size()];
          for (std::size_t c = 0; c < free.size(); ++c) {
            a += *FindNumber(complete, free[c]) * row[c];
          }
          actual.push_back(a);
          EXPECT_NEAR(Norm(row[free.size() + 1]), 1, 1e-6);
        }
        EXPECT_LT(Largest(actual, expected), 1e-8) << name << taper << all_free;
      }
    }
  }
}

TEST(SceneTerms, SmoothOnesAreTheEnginesAtAnyParametersAndHaveTheirSlopes) {
  const Flock flock = RandomFlock(60, 5);
  TermSurroundings around;
  const World world = Surround(&around);
  const ModelSpec model = CompleteModel(Model("forces", AllTerms(0.8)));
  const std::vector<std::string> free = SmoothTermParameters(model).value();
  EXPECT_EQ(std::count(free.begin(), free.end(), "alignment2.radius"), 1);
  const ProcessModel process = MakeProcessModel(model, free, world.box, around);
  ModelSpec other = model;
  std::vector<double> theta = process.start;
  for (std::size_t k = 0; k < free.size(); ++k) *FindNumber(&other, free[k]) = theta[k] *= 1.2;
  other.parameters["s_max"] = 1e5;
  std::vector<Vec3d> a(flock.x.size());
  std::vector<OwnSlope> slopes(flock.x.size());
  process.evaluate(theta, flock.x, flock.v, a, slopes);
  EXPECT_LT(Largest(a, EngineAccelerations(world, other, flock, 0)), 1e-8);
  constexpr double kStep = 1e-5;
  for (std::size_t i = 0; i < flock.x.size(); i += 7) {
    for (std::size_t column = 0; column < 6; ++column) {
      std::vector<Vec3d> ends[2] = {a, a};
      for (const int sign : {0, 1}) {
        Flock moved = flock;
        Vec3d& of = column < 3 ? moved.x[i] : moved.v[i];
        (column % 3 == 0 ? of.x : column % 3 == 1 ? of.y : of.z) += sign == 0 ? -kStep : kStep;
        process.evaluate(theta, moved.x, moved.v, ends[sign], {});
      }
      const Vec3d numeric = (ends[1][i] - ends[0][i]) / (2 * kStep);
      const auto& of = column < 3 ? slopes[i].position : slopes[i].velocity;
      const std::size_t at = column % 3;
      EXPECT_NEAR(of[at], numeric.x, 1e-6 * (1 + std::abs(numeric.x)));
      EXPECT_NEAR(of[3 + at], numeric.y, 1e-6 * (1 + std::abs(numeric.y)));
      EXPECT_NEAR(of[6 + at], numeric.z, 1e-6 * (1 + std::abs(numeric.z)));
    }
  }
}

TEST(SceneTerms, AreSmoothOnlyWithoutEdgesMemoryAndUnknownFields) {
  const auto smooth = [](const ModelSpec& term) {
    return SmoothTermParameters(Model("forces", {term})).has_value();
  };
  EXPECT_TRUE(smooth(Term("alignment", {{"taper", 1}})));
  EXPECT_FALSE(smooth(Term("alignment", {{"taper", 0}})));
  EXPECT_TRUE(smooth(Term("noise", {{"time", 0}})));
  EXPECT_FALSE(smooth(Term("noise", {})));
  EXPECT_FALSE(smooth(Term("cruise", {})));
  EXPECT_FALSE(smooth(Term("curl", {})));
  EXPECT_FALSE(smooth(Term("flee", {})));
  EXPECT_EQ(UnknownTerm(Model("forces", {Term("drag", {})})), "");
  EXPECT_NE(UnknownTerm(Model("forces", {Term("perlin", {})})), "");
}

// 25 birds that align with those near and, the other way, with those far; hard edges.
Scene TermScene(std::uint64_t seed) {
  Scene scene;
  scene.seed = seed;
  scene.duration = 12;
  scene.warmup = 3;
  scene.box = {{-12, -12, 0}, {12, 12, 24}};
  scene.wind.velocity = {3, 0, 0};
  SpeciesSpec birds;
  birds.count = 25;
  birds.speed = 8;
  birds.model.name = "forces";
  birds.forces = {Term("alignment", {{"gain", 1.2}, {"radius", 4}}),
                  Term("alignment", {{"gain", 0.4}, {"radius", 12}}),
                  Term("cohesion", {{"gain", 0.15}, {"radius", 12}}),
                  Term("walls", {{"gain", 8}, {"taper", 6}}),
                  Term("cruise", {{"rate", 0.9}}),
                  Term("level", {{"rate", 0.5}}),
                  Term("wind", {{"rate", 0.3}}),
                  Term("noise", {{"sd", 2.5}, {"time", 0.5}})};
  scene.species = {birds};
  return scene;
}

FitProblem ProblemOf(const Scene& scene) {
  FitProblem problem;
  problem.model = scene.species[0].model;
  for (const ModelSpec& force : scene.species[0].forces) {
    problem.model.terms.push_back(CompleteForce(force));
  }
  problem.scene = scene;
  return problem;
}

double TruthOf(const Scene& scene, const std::string& name) {
  return *FindNumber(ProblemOf(scene).model, name);
}

const FittedWeight& WeightOf(const FitResult& result, const std::string& name) {
  const auto found = std::find_if(result.weights.begin(), result.weights.end(),
                                  [&](const FittedWeight& w) { return w.name == name; });
  if (found == result.weights.end()) throw std::logic_error("no weight " + name);
  return *found;
}

TEST(SceneTermFit, RegressionFindsAllGains) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Scene scene = TermScene(seed);
    FitProblem problem = ProblemOf(scene);
    for (const std::string& name : TermWeights(problem.model)) {
      *FindNumber(&problem.model, name) = 0.1;
    }
    const FitResult fit = FitModel({}, problem, Fly(scene), scene.fps, 1, 2);
    ASSERT_TRUE(fit.IsUsable());
    EXPECT_EQ(fit.method, FitMethod::kErrorsInVariables);
    ASSERT_EQ(fit.weights.size(), 7U);
    for (const FittedWeight& weight : fit.weights) {
      EXPECT_LT(std::abs(weight.estimate - TruthOf(scene, weight.name)), 3 * weight.sd)
          << weight.name << seed;
    }
  }
}

// Where nobody comes near the walls, and air at rest brakes as the wind does.
TEST(SceneTermFit, WhatTheMotionDoesNotTellIsFlagged) {
  Scene scene = TermScene(4);
  scene.box = {{-500, -500, -500}, {500, 500, 500}};
  scene.species[0].start = Region{{-6, -6, -6}, {6, 6, 6}};
  scene.wind.velocity = {};
  scene.species[0].forces.push_back(Term("drag", {{"rate", 0.2}}));
  const FitProblem problem = ProblemOf(scene);
  const FitResult fit = FitModel({}, problem, Fly(scene), scene.fps, 1, 2);
  ASSERT_TRUE(fit.IsUsable());
  EXPECT_FALSE(WeightOf(fit, "walls.gain").determined);
  EXPECT_FALSE(WeightOf(fit, "wind.rate").determined);
  EXPECT_FALSE(WeightOf(fit, "drag.rate").determined);
  EXPECT_TRUE(WeightOf(fit, "alignment.gain").determined);
  EXPECT_LT(std::abs(WeightOf(fit, "alignment.gain").estimate - 1.2),
            3 * WeightOf(fit, "alignment.gain").sd);
}

// Edges with a width: radii are among the unknowns of a state-space estimate.
Scene SmoothScene(std::uint64_t seed) {
  Scene scene = TermScene(seed);
  scene.duration = 8;
  SpeciesSpec& birds = scene.species[0];
  birds.forces = {Term("alignment", {{"gain", 0.8}, {"radius", 5}, {"taper", 2}}),
                  Term("cohesion", {{"gain", 0.2}, {"radius", 12}, {"taper", 2}}),
                  Term("walls", {{"gain", 8}, {"taper", 6}}), Term("drag", {{"rate", 0.15}}),
                  Term("noise", {{"sd", 12}, {"time", 0}})};
  return scene;
}

TEST(SceneTermFit, StateSpaceFindsGainsAndARadius) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Scene scene = SmoothScene(seed);
    FitProblem problem = ProblemOf(scene);
    problem.free = {"alignment.gain", "alignment.radius", "cohesion.gain", "drag.rate"};
    *FindNumber(&problem.model, "alignment.gain") = 0.5;
    *FindNumber(&problem.model, "alignment.radius") = 6;
    const FitResult fit = FitModel({}, problem, Fly(scene), scene.fps, 1, 2);
    ASSERT_TRUE(fit.IsUsable());
    EXPECT_EQ(fit.method, FitMethod::kStateSpace);
    EXPECT_TRUE(fit.converged);
    for (const FittedWeight& weight : fit.weights) {
      EXPECT_LT(std::abs(weight.estimate - TruthOf(scene, weight.name)), 3 * weight.sd)
          << weight.name << seed;
    }
    EXPECT_NEAR(fit.noise_sd, 12, 0.6);
    EXPECT_EQ(fit.parameters.model.terms.back().parameters.at("sd"), fit.noise_sd);
  }
}

// A field of noise is not known, and what adds to bswarm has no derivatives either.
TEST(SceneTermFit, StatisticsFindATermsGain) {
  for (const std::uint64_t seed : {1, 2}) {
    Scene scene = TermScene(seed);
    scene.fps = 15;
    scene.duration = 4;
    SpeciesSpec& birds = scene.species[0];
    birds.forces = {Term("walls", {{"gain", 8}, {"taper", 6}}),
                    Term("alignment", {{"gain", 1}, {"radius", 6}}),
                    Term("curl", {{"gain", 30}, {"scale", 6}}), Term("drag", {{"rate", 0.1}})};
    FitProblem problem = ProblemOf(scene);
    problem.free = {"curl.gain", "alignment.gain"};
    *FindNumber(&problem.model, "curl.gain") = 20;
    FitOptions options;
    options.local_evaluations = 60;
    problem.search = SimulatedSearch::kBobyqa;
    const FitResult fit = FitModel(options, problem, Fly(scene), scene.fps, 1, 2);
    ASSERT_TRUE(fit.IsUsable());
    EXPECT_EQ(fit.method, FitMethod::kStatistics);
    for (const FittedWeight& weight : fit.weights) {
      EXPECT_LT(std::abs(weight.value - TruthOf(scene, weight.name)), 3 * weight.sd)
          << weight.name << seed;
      EXPECT_LT(weight.sd, 0.7 * weight.value) << weight.name << seed;
    }
  }
}

TEST(SceneTermFit, FindsWhatAddsToAModelsOwnForces) {
  Scene scene = BoidsScene(6);
  scene.duration = 20;
  scene.wind.velocity = {0, 4, 0};
  scene.species[0].forces = {Term("wind", {{"rate", 0.3}})};
  FitProblem problem = ProblemOf(scene);
  *FindNumber(&problem.model, "wind.rate") = 0;
  const FitResult fit = FitModel({}, problem, Fly(scene), scene.fps, 1, 2);
  ASSERT_TRUE(fit.IsUsable());
  ASSERT_EQ(fit.weights.size(), 7U);
  for (const FittedWeight& weight : fit.weights) {
    EXPECT_LT(std::abs(weight.estimate - TruthOf(scene, weight.name)), 3 * weight.sd)
        << weight.name;
  }
  EXPECT_TRUE(WeightOf(fit, "wind.rate").determined);
  EXPECT_EQ(*FindNumber(fit.parameters.model, "wind.rate"), WeightOf(fit, "wind.rate").value);
}

TEST(SceneTermFit, StatisticsFindWhatAddsToAModelWithoutDerivatives) {
  Scene scene = TermScene(7);
  scene.fps = 20;
  scene.duration = 4;
  SpeciesSpec& flies = scene.species[0];
  flies.speed = 2;
  flies.model.name = "bswarm";
  flies.start = Region{{-2, -2, 10}, {2, 2, 14}};
  flies.forces = {Term("wind", {{"rate", 0.8}})};
  scene.warmup = 0;
  scene.wind.velocity = {8, 0, 0};
  scene.box = {{-200, -200, -200}, {200, 200, 200}};
  FitProblem problem = ProblemOf(scene);
  problem.free = {"wind.rate"};
  problem.search = SimulatedSearch::kBobyqa;
  FitOptions options;
  options.local_evaluations = 60;
  *FindNumber(&problem.model, "wind.rate") = 0.5;
  const FitResult fit = FitModel(options, problem, Fly(scene), scene.fps, 1, 2);
  ASSERT_TRUE(fit.IsUsable());
  for (const FittedWeight& weight : fit.weights) {
    EXPECT_LT(weight.sd, 0.25 * weight.value);
    EXPECT_LT(std::abs(weight.value - TruthOf(scene, weight.name)), 3 * weight.sd) << weight.name;
  }
}

TEST(SceneTermFit, SaysWhatCannotBeNamed) {
  const Scene scene = TermScene(1);
  const Trajectories flock = Fly(scene);
  const auto fault = [&](const FitProblem& problem) -> std::string {
    try {
      FitModel({}, problem, flock, scene.fps, 1, 1);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  FitProblem problem = ProblemOf(scene);
  problem.free = {"alignment3.gain"};
  EXPECT_NE(fault(problem).find("did you mean `alignment"), std::string::npos) << fault(problem);
  problem.free = {"drag.rat"};
  EXPECT_NE(fault(problem), "");
  problem.free = {};
  problem.model.terms.push_back(CompleteForce(Term("curl", {})));
  problem.method = FitMethod::kErrorsInVariables;
  EXPECT_NE(fault(problem).find("statistics"), std::string::npos) << fault(problem);
  problem.model.terms.clear();
  EXPECT_NE(fault(problem).find("--scene"), std::string::npos) << fault(problem);
}

}  // namespace
}  // namespace flocklift
