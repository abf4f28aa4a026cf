// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/flock_terms.h"

#include <gtest/gtest.h>

#include "simulate/core/check.h"
#include "simulate/core/rng.h"
#include "simulate/flock/engine.h"

namespace flocklift {
namespace {

struct State {
  std::vector<Vec3d> position, velocity;
};

State Crowd(int n) {
  State state;
  Rng rng(17);
  for (int i = 0; i < n; ++i) {
    state.position.push_back({rng.Uniform(-9, 9), rng.Uniform(-9, 9), rng.Uniform(0, 12)});
    state.velocity.push_back({10 + rng.Normal(), rng.Normal(), rng.Normal()});
  }
  return state;
}

ModelSpec Boids(std::map<std::string, double> parameters) {
  return {.name = "boids", .parameters = std::move(parameters), .where = {}, .where_of = {}};
}

std::vector<Vec3d> Evaluate(const FlockTerms& terms, const State& state) {
  std::vector<Vec3d> out(state.position.size() * terms.columns());
  terms.evaluate(state.position, state.velocity, out);
  return out;
}

// The engine's own change of velocity in one small step, per second.
std::vector<Vec3d> EngineAccelerations(const ModelSpec& model, const State& state,
                                       const World& world, double cruising_speed) {
  Swarm swarm;
  swarm.model = ResolveModel(model);
  swarm.position = state.position;
  swarm.velocity = state.velocity;
  swarm.cruising_speed.assign(state.position.size(), cruising_speed);
  ReferenceEngine engine(world, {swarm}, {});
  engine.Step();
  const FlockState after = engine.State();
  std::vector<Vec3d> accelerations;
  for (std::size_t k = 0; k < state.position.size(); ++k) {
    accelerations.push_back((after.velocity[k] - state.velocity[k]) / world.dt);
  }
  return accelerations;
}

TEST(FlockTerms, WeightedTermsAddUpToTheEngine) {
  const std::map<std::string, double> weights = {{"alpha_s", 1.3}, {"alpha_c", 0.2},
                                                 {"alpha_a", 0.7}, {"alpha_b", 5.0},
                                                 {"cruise", 1.1},  {"level", 0.4}};
  std::map<std::string, double> parameters = weights;
  parameters.insert({{"noise", 0}, {"s_min", 0}, {"s_max", 1000}, {"d_s", 3}, {"d_v", 7}});
  const State state = Crowd(60);
  World world;
  world.dt = 1e-4;
  world.box = {{-6, -6, 3}, {6, 6, 9}};
  GoalSpec goal;
  goal.position = {20, 5, -3};
  goal.weight = 0.6;
  world.goals = {goal};
  const double own_speed = 9;
  const auto engine = EngineAccelerations(Boids(parameters), state, world, own_speed);

  std::vector<std::string> free = LinearWeights(Boids({}));
  free.push_back(kGoalWeight);
  const FlockTerms all_free = MakeFlockTerms(Boids(parameters), free, world.box, goal);
  const FlockTerms all_known = MakeFlockTerms(Boids(parameters), {}, world.box, goal);
  const auto terms = Evaluate(all_free, state), known = Evaluate(all_known, state);
  for (std::size_t k = 0; k < state.position.size(); ++k) {
    const Vec3d* const row = &terms[k * all_free.columns()];
    Vec3d sum = (weights.at("cruise") * own_speed) * row[free.size() + 1];
    for (std::size_t c = 0; c < free.size(); ++c) {
      sum += (free[c] == kGoalWeight ? goal.weight : weights.at(free[c])) * row[c];
    }
    EXPECT_EQ(row[free.size()], Vec3d{});  // nothing is known
    EXPECT_LT(Norm(sum - engine[k]), 1e-6 * (1 + Norm(engine[k])));
    const Vec3d given = known[2 * k] + (weights.at("cruise") * own_speed) * known[2 * k + 1];
    EXPECT_LT(Norm(given - engine[k]), 1e-6 * (1 + Norm(engine[k])));
  }
}

TEST(FlockTerms, WeightsKeepTheModelsTimeUnit) {
  // boids2d counts in pixels and steps of 1/30 s: its terms must give what the engine gives.
  ModelSpec model;
  model.name = "boids2d";
  model.parameters = {{"s_min", 0}, {"s_max", 1e6}};
  State state;
  Rng rng(5);
  for (int i = 0; i < 30; ++i) {
    state.position.push_back({rng.Uniform(0, 300), rng.Uniform(0, 300), 0});
    state.velocity.push_back({30 * rng.Normal(), 30 * rng.Normal(), 0});
  }
  World world;
  world.dt = 1e-4;
  world.dimensions = 2;
  const auto engine = EngineAccelerations(model, state, world, 0);
  const std::vector<std::string> free = {"alpha_s", "alpha_c", "alpha_a"};
  const FlockTerms terms = MakeFlockTerms(model, free, {});
  const auto columns = Evaluate(terms, state);
  for (std::size_t k = 0; k < state.position.size(); ++k) {
    const Vec3d* const row = &columns[k * terms.columns()];
    const Vec3d sum = 0.02 * row[0] + 0.001 * row[1] + 0.03 * row[2];
    EXPECT_LT(Norm(sum - engine[k]), 1e-6 * (1 + Norm(engine[k])));
  }
}

TEST(FlockTerms, LinearModel) {
  ModelSpec model;
  model.name = "linear";
  const FlockTerms terms = MakeFlockTerms(model, {"alignment", "cohesion"}, {});
  State pair;
  pair.position = {{0, 0, 0}, {1, 2, 3}};
  pair.velocity = {{0, 0, 0}, {4, 5, 6}};
  const auto columns = Evaluate(terms, pair);
  EXPECT_EQ(columns[0], (Vec3d{4, 5, 6}));
  EXPECT_EQ(columns[1], (Vec3d{1, 2, 3}));
  EXPECT_EQ(columns[5], (Vec3d{-1, -2, -3}));
  EXPECT_FALSE(terms.has_own_speed);
}

TEST(FlockTerms, UnknownNamesAreTold) {
  EXPECT_THROW(MakeFlockTerms(Boids({}), {"goal"}, {}), InputError);
  EXPECT_THROW(MakeFlockTerms(Boids({}), {"d_v"}, {}), InputError);
  EXPECT_THROW(MakeFlockTerms(Boids({{"alpha", 1}}), {}, {}), InputError);
  ModelSpec lin;
  lin.name = "lin";
  EXPECT_THROW(MakeFlockTerms(lin, {}, {}), InputError);
  EXPECT_TRUE(
      LinearWeights({.name = "lin", .parameters = {}, .where = {}, .where_of = {}}).empty());
}

}  // namespace
}  // namespace flocklift
