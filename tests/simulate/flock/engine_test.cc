// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/engine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/simulate/flock/flocks.h"

namespace flocklift {
namespace {

// Everything at once: noise, predators, goals, walls, two species.
Engine BusyEngine(int threads, const std::string& kernel = "") {
  World world;
  world.seed = 9;
  world.dt = 0.01;
  world.box = {{-5, -5, -5}, {15, 15, 15}};
  world.goals = {{.species = "bird", .position = {5, 5, 5}, .radius = 3, .period = 4, .weight = 1}};
  world.predators = {
      {.count = 2, .speed = 8, .fear_radius = 4, .fear_weight = 9, .turn_interval = 0.3}};
  Swarm birds = AsSwarm(RandomFlock("", 700, {10, 10, 10}, 1), BoidsParameters<double>{});
  Swarm others = AsSwarm(RandomFlock("", 300, {10, 10, 10}, 2), LinParameters<double>{});
  others.species = "other";
  return Engine(world, {birds, others}, {.threads = threads, .kernel = kernel});
}

void ExpectSameBytes(const FlockState& a, const FlockState& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.velocity, b.velocity);
}

FlockState After(Engine engine, int steps) {
  for (int k = 0; k < steps; ++k) engine.Step();
  return engine.State();
}

TEST(Engine, SameBytesAtAnyThreadCountAndWithAnyKernel) {
  const FlockState expected = After(BusyEngine(1), 25);
  ASSERT_EQ(expected.size(), 1002U);
  ExpectSameBytes(After(BusyEngine(2), 25), expected);
  ExpectSameBytes(After(BusyEngine(5), 25), expected);
  ExpectSameBytes(After(BusyEngine(2, "scalar"), 25), expected);
  ExpectSameBytes(After(BusyEngine(1, "sse2"), 25), expected);
}

TEST(Engine, NeighbourCountDoesNotDependOnTheThreads) {
  Engine one = BusyEngine(1), two = BusyEngine(2);
  for (int k = 0; k < 10; ++k) {
    one.Step();
    two.Step();
  }
  EXPECT_EQ(one.MeanNeighbours(), two.MeanNeighbours());
  EXPECT_GT(one.MeanNeighbours(), 1);
  EXPECT_EQ(one.steps(), 10);
  EXPECT_NEAR(one.time(), 0.1, 1e-12);
}

TEST(Engine, FloatFollowsDouble) {
  World world;
  world.dt = 0.01;
  const Swarm swarm = AsSwarm(RandomFlock("", 200, {10, 10, 10}, 3), PlainRules(1, 3, 1));
  Engine engine(world, {swarm}, {});
  ReferenceEngine reference(world, {swarm}, {});
  for (int k = 0; k < 20; ++k) {
    engine.Step();
    reference.Step();
  }
  const FlockState a = engine.State(), b = reference.State();
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_LT(Norm(a.position[k] - b.position[k]), 1e-4);
    EXPECT_LT(Norm(a.velocity[k] - b.velocity[k]), 1e-4);
  }
}

TEST(Engine, TwoDimensionsStayTwo) {
  World world;
  world.dimensions = 2;
  world.box = {{0, 0, 2}, {10, 10, 22}};  // a box in z means nothing here
  NamedFlock flock = RandomFlock("", 100, {10, 10, 10}, 3);
  BoidsParameters<double> p;  // with noise
  Engine engine(world, {AsSwarm(flock, p)}, {});
  for (int k = 0; k < 100; ++k) engine.Step();
  const FlockState state = engine.State();
  double most = 0;
  for (std::size_t k = 0; k < state.size(); ++k) {
    EXPECT_EQ(state.position[k].z, 0);
    EXPECT_EQ(state.velocity[k].z, 0);
    most = std::max(most, std::abs(state.velocity[k].y));
  }
  EXPECT_GT(most, 1);
}

TEST(Engine, SemiImplicitEulerByHand) {
  // One bird, one goal at (4, 0, 0), far range: a = 0.5 * 4 = 2; v = 1 + 2 dt, x = 0 + v dt.
  World world;
  world.dt = 0.25;
  world.goals = {{.species = "", .position = {4, 0, 0}, .weight = 0.5}};
  BoidsParameters<double> p = PlainRules(1, 1);
  p.goal_range = 1e9;
  ReferenceEngine engine(world, {AsSwarm({"", {{0, 0, 0}}, {{1, 0, 0}}}, p)}, {});
  engine.Step();
  EXPECT_NEAR(engine.State().velocity[0].x, 1.5, 1e-12);
  EXPECT_NEAR(engine.State().position[0].x, 0.375, 1e-12);
}

TEST(Engine, SpeedsStayBetweenTheirLimits) {
  World world;
  world.dt = 0.02;
  BoidsParameters<double> p;
  p.s_min = 8;
  p.s_max = 9;
  Engine engine(world, {AsSwarm(RandomFlock("", 100, {10, 10, 10}, 4), p)}, {});
  for (int k = 0; k < 50; ++k) engine.Step();
  for (const Vec3d& v : engine.State().velocity) {
    EXPECT_GT(Norm(v), 8 - 1e-5);
    EXPECT_LT(Norm(v), 9 + 1e-5);
  }
}

TEST(Engine, EachBirdReturnsToItsOwnSpeed) {
  World world;
  BoidsParameters<double> p = PlainRules(0, 0);
  p.cruise = 2;
  Swarm swarm = AsSwarm({"", {{0, 0, 0}, {9, 0, 0}}, {{5, 0, 0}, {0, 5, 0}}}, p);
  swarm.cruising_speed = {8, 11};
  Engine engine(world, {swarm}, {});
  for (int k = 0; k < 600; ++k) engine.Step();
  EXPECT_NEAR(Norm(engine.State().velocity[0]), 8, 1e-3);
  EXPECT_NEAR(Norm(engine.State().velocity[1]), 11, 1e-3);
}

TEST(Engine, WallsTurnBirdsBack) {
  World world;
  world.box = {{-10, -10, -10}, {10, 10, 10}};
  Engine engine(world, {AsSwarm(RandomFlock("", 50, {5, 5, 5}, 4), BoidsParameters<double>{})}, {});
  double furthest = 0;
  for (int k = 0; k < 2000; ++k) {
    engine.Step();
    for (const Vec3d& x : engine.State().position) furthest = std::max(furthest, Norm(x));
  }
  EXPECT_GT(furthest, 9);  // they get there
  EXPECT_LT(furthest, 60);
}

TEST(Engine, BirdsFleeFromPredators) {
  // A predator that stands still in the middle of the box, or no predator.
  World world;
  world.box = {{-1e-3, -1e-3, -1e-3}, {1e-3, 1e-3, 1e-3}};
  BoidsParameters<double> p = PlainRules(0, 0);
  const Swarm swarm = AsSwarm({"", {{2, 0, 0}, {0, -9, 0}}, {{}, {}}}, p);
  world.predators = {
      {.count = 1, .speed = 0, .fear_radius = 5, .fear_weight = 3, .turn_interval = 1}};
  Engine engine(world, {swarm}, {});
  for (int k = 0; k < 60; ++k) engine.Step();
  const FlockState state = engine.State();
  ASSERT_EQ(state.size(), 3U);  // the predator has the last id
  EXPECT_NEAR(state.velocity[0].x, 3 * 0.5, 0.01);
  EXPECT_EQ(state.velocity[1], (Vec3d{}));  // too far to see it
}

TEST(Engine, NoiseHasItsSpreadAndItsMemory) {
  // Free birds with nothing but noise a: var(v(t)) = 2 s^2 tau (t - tau (1 - exp(-t / tau))) once
  // the noise is stationary; it starts from 0, which costs it one tau or so.
  World world;
  world.dt = 0.01;
  BoidsParameters<double> p = PlainRules(0, 0);
  p.noise = 2;
  p.noise_time = 0.1;
  NamedFlock flock = RandomFlock("", 1000, {1000, 1000, 1000}, 5);
  for (Vec3d& v : flock.velocity) v = {};
  Engine engine(world, {AsSwarm(flock, p)}, {});
  for (int k = 0; k < 500; ++k) engine.Step();
  double variance = 0;
  for (const Vec3d& v : engine.State().velocity) variance += SquaredNorm(v) / 3 / 1000;
  EXPECT_NEAR(variance, 2 * 4 * 0.1 * (5 - 0.15), 0.3);
}

TEST(Engine, DivergenceIsToldNotReturned) {
  World world;
  world.dt = 1e20;
  BoidsParameters<double> p = PlainRules(5, 5);
  p.s_max = 1e30;
  Engine engine(world, {AsSwarm(RandomFlock("", 20, {1, 1, 1}, 1), p)}, {});
  EXPECT_THROW(
      {
        for (int k = 0; k < 10; ++k) engine.Step();
      },
      std::runtime_error);
}

TEST(Engine, RefusesSwarmsThatMakeNoSense) {
  Swarm swarm = AsSwarm(RandomFlock("", 5, {1, 1, 1}, 1), PlainRules(1, 1));
  swarm.velocity.pop_back();
  EXPECT_THROW(Engine(World{}, {swarm}, {}), std::invalid_argument);
  World still;
  still.dt = 0;
  EXPECT_THROW(Engine(still, {}, {}), std::invalid_argument);
}

TEST(Goal, MovesOnItsCircle) {
  const GoalSpec goal{.species = "", .position = {1, 2, 3}, .radius = 4, .period = 8};
  EXPECT_LT(Norm(GoalPosition(goal, 0) - Vec3d{5, 2, 3}), 1e-12);
  EXPECT_LT(Norm(GoalPosition(goal, 2) - Vec3d{1, 6, 3}), 1e-12);
  EXPECT_LT(Norm(GoalPosition(goal, -2) - Vec3d{1, -2, 3}), 1e-12);
  EXPECT_EQ(GoalPosition({.species = "", .position = {1, 2, 3}}, 5), (Vec3d{1, 2, 3}));
}

// ---- Lin ----------------------------------------------------------------------------------------

// Algorithms 1 and 2, over all pairs.
Vec3d LinTargetByHand(const NamedFlock& flock, std::size_t n, double w_sep, double d_sep,
                      double exponent) {
  Vec3d s, c;
  double neighbours = 0;
  const auto count = static_cast<double>(flock.position.size());
  for (std::size_t i = 0; i < flock.position.size(); ++i) {
    if (i == n) continue;
    const Vec3d offset = flock.position[n] - flock.position[i];
    c += -offset / (count - 1);
    if (Norm(offset) <= d_sep) {
      ++neighbours;
      s += offset / std::pow(Norm(offset), 1 + exponent);
    }
  }
  if (neighbours > 0) s = s / neighbours;
  return flock.position[n] + w_sep * s + (1 - w_sep) * c;
}

TEST(Lin, GainOneIsThePublishedStep) {
  const NamedFlock flock = RandomFlock("", 30, {6, 6, 6}, 7);
  for (const double exponent : {0.0, 1.0}) {
    LinParameters<double> p;
    p.w_sep = 0.6;
    p.d_sep = 2;
    p.exponent = exponent;
    p.gain = 1;
    p.s_max = 1e9;
    World world;
    world.dt = p.frame_time;
    ReferenceEngine engine(world, {AsSwarm(flock, p)}, {});
    engine.Step();
    for (std::size_t n = 0; n < 30; ++n) {
      const Vec3d target = LinTargetByHand(flock, n, 0.6, 2, exponent);
      EXPECT_LT(Norm(engine.State().position[n] - target), 1e-8) << n;
      // Velocity is the displacement.
      EXPECT_LT(Norm(p.frame_time * engine.State().velocity[n] - (target - flock.position[n])),
                1e-8);
    }
  }
}

TEST(Lin, HomingLeadsHome) {
  LinParameters<double> p;
  p.home = 2;
  World world;
  world.goals = {{.species = "", .position = {30, 0, 0}}};
  Engine engine(world, {AsSwarm(RandomFlock("", 5, {6, 6, 6}, 7), p)}, {});
  for (int k = 0; k < 1200; ++k) engine.Step();
  Vec3d mean;
  for (const Vec3d& x : engine.State().position) mean += 0.2 * x;
  EXPECT_LT(Norm(mean - Vec3d{30, 0, 0}), 0.1);
}

// ---- linear -------------------------------------------------------------------------------------

TEST(Linear, EqualsTheSumOverPairs) {
  const NamedFlock flock = RandomFlock("", 12, {3, 3, 3}, 8);
  LinearParameters<double> p;
  p.cohesion = 0.3;
  p.alignment = 0.2;
  p.diffusion = 0;
  World world;
  world.dt = 0.1;
  ReferenceEngine engine(world, {AsSwarm(flock, p)}, {});
  engine.Step();
  for (std::size_t i = 0; i < 12; ++i) {
    Vec3d a;
    for (std::size_t j = 0; j < 12; ++j) {
      a += 0.3 * (flock.position[j] - flock.position[i]) +
           0.2 * (flock.velocity[j] - flock.velocity[i]);
    }
    const Vec3d v = flock.velocity[i] + 0.1 * a;
    EXPECT_LT(Norm(engine.State().velocity[i] - v), 1e-12);
    EXPECT_LT(Norm(engine.State().position[i] - (flock.position[i] + 0.1 * v)), 1e-12);
  }
}

TEST(Linear, DiffusesAtItsRate) {
  NamedFlock flock = RandomFlock("", 2000, {1, 1, 1}, 8);
  for (Vec3d& v : flock.velocity) v = {};
  LinearParameters<double> p{0, 0, 0.7};
  World world;
  world.dt = 0.01;
  Engine engine(world, {AsSwarm(flock, p)}, {});
  for (int k = 0; k < 50; ++k) engine.Step();
  double variance = 0;
  for (const Vec3d& v : engine.State().velocity) variance += SquaredNorm(v) / 3 / 2000;
  EXPECT_NEAR(variance, 2 * 0.7 * 0.5, 0.05);
}

TEST(Engine, GoesOnFromASavedStateAsIfNothingHadBeen) {
  Engine whole = BusyEngine(1), first = BusyEngine(2), second = BusyEngine(1);
  for (int k = 0; k < 12; ++k) first.Step();
  second.Load(first.Save());
  for (int k = 0; k < 13; ++k) second.Step();
  for (int k = 0; k < 25; ++k) whole.Step();
  ExpectSameBytes(second.State(), whole.State());
  EXPECT_EQ(second.MeanNeighbours(), whole.MeanNeighbours());
  EXPECT_EQ(second.steps(), 25);
}

TEST(Engine, RefusesTheStateOfAnotherFlock) {
  World world;
  Engine other(world, {AsSwarm(RandomFlock("", 7, {1, 1, 1}, 1), PlainRules(1, 1))}, {});
  Engine busy = BusyEngine(1);
  EXPECT_THROW(busy.Load(other.Save()), std::runtime_error);
  std::string bytes = busy.Save();
  bytes.resize(bytes.size() - 5);
  EXPECT_THROW(busy.Load(bytes), std::runtime_error);
}

TEST(Engine, EventsChangeParametersGoalsAndWind) {
  World world;
  world.dt = 0.1;
  world.goals = {{.species = "", .position = {10, 0, 0}, .weight = 1}};
  EventSpec faster, jump, storm;
  faster.time = 1;
  faster.change.parameters = {{"s_max", 3}};
  jump.time = 2;
  jump.goal = 1;
  jump.position = {0, -50, 0};
  storm.time = 3;
  storm.wind = Vec3d{0, 0, 9};
  world.events = {faster, jump, storm};
  Swarm swarm = AsSwarm({"", {{0, 0, 0}}, {{1, 0, 0}}}, ForcesParameters{.s_min = 0, .s_max = 1});
  swarm.spec = {.name = "forces", .parameters = {{"s_max", 1}}, .where = {}, .where_of = {}};
  ModelSpec goal, wind;
  goal.name = "goal";
  wind.name = "wind";
  wind.parameters = {{"rate", 2}};
  swarm.forces = {goal, wind};
  ReferenceEngine engine(world, {swarm}, {});
  const auto velocity_at = [&engine](double time) {
    while (engine.time() < time - 1e-9) engine.Step();
    return engine.State().velocity[0];
  };
  EXPECT_NEAR(velocity_at(1.0).x, 1, 1e-9);  // as fast as it may, towards the goal
  EXPECT_GT(velocity_at(1.9).x, 1.5);
  EXPECT_LT(velocity_at(2.9).y, -1.5);
  EXPECT_NEAR(engine.State().velocity[0].z, 0, 1e-9);
  EXPECT_GT(velocity_at(3.5).z, 1);
}

TEST(Engine, EventsThatMakeNoSenseFailAtOnce) {
  World world;
  EventSpec event;
  event.change.parameters = {{"s_mox", 3}};
  world.events = {event};
  Swarm swarm = AsSwarm({"", {{0, 0, 0}}, {{1, 0, 0}}}, PlainRules(1, 1));
  swarm.spec.name = "boids";
  EXPECT_THROW(Engine(world, {swarm}, {}), InputError);
  EventSpec jump;
  jump.goal = 1;
  world.events = {jump};
  EXPECT_THROW(Engine(world, {swarm}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
