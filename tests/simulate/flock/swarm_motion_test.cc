// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/swarm_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "simulate/core/check.h"
#include "simulate/core/rng.h"
#include "simulate/flock/engine.h"
#include "simulate/flock/kernels/swarm_kernel.h"
#include "simulate/shapes/solid_meshes.h"

namespace flocklift {
namespace {

SwarmParameters Quiet() {
  SwarmParameters p;
  p.noise.index = static_cast<int>(SwarmNoiseKind::kNone);
  p.d_min = 0;
  return p;
}
SwarmParameters WithNoise(SwarmNoiseKind kind, double gain = 0.25, double scale = 0.4) {
  SwarmParameters p = Quiet();
  p.noise.index = static_cast<int>(kind);
  p.gain = gain;
  p.scale = scale;
  return p;
}

Swarm Uniform(const std::string& name, const SwarmParameters& p, int count, const Region& region,
              std::uint64_t seed = 1) {
  Swarm swarm;
  swarm.species = name;
  swarm.model = p;
  Rng rng(seed);
  for (int k = 0; k < count; ++k) {
    swarm.position.push_back({rng.Uniform(region.low.x, region.high.x),
                              rng.Uniform(region.low.y, region.high.y),
                              rng.Uniform(region.low.z, region.high.z)});
    swarm.velocity.push_back({1, 0, 0});
  }
  return swarm;
}

Obstacle BoxObstacle(const Vec3d& low, const Vec3d& high) {
  return {BoxMesh(low, high), Block{low, high}};
}

GoalSpec BallGoal(const Vec3d& position, double reach, const std::string& species = "") {
  GoalSpec goal;
  goal.species = species;
  goal.position = position;
  goal.reach = reach;
  return goal;
}

// A hall with a wall across, which has a gap in the middle.
World Hall() {
  World world;
  world.dt = 1.0 / 30;
  world.box = {{0, -3, 0}, {12, 3, 4}};
  world.goals = {BallGoal({10, 0, 2}, 1)};
  world.obstacles.push_back(BoxObstacle({5, -3, 0}, {6, -0.8, 4}));
  world.obstacles.push_back(BoxObstacle({5, 0.8, 0}, {6, 3, 4}));
  return world;
}
const Region kEntrance{{0.5, -2.5, 0.5}, {3.5, 2.5, 3.5}};

FlockState After(const World& world, const std::vector<Swarm>& swarms, int steps,
                 const EngineOptions& options = {}) {
  Engine engine(world, swarms, options);
  for (int k = 0; k < steps; ++k) engine.Step();
  return engine.State();
}

TEST(SwarmMotion, FliesToItsGoalAtItsSpeed) {
  World world;
  world.dt = 0.05;
  world.box = {{0, -3, -3}, {12, 3, 3}};
  world.goals = {BallGoal({10, 0, 0}, 1)};
  Swarm swarm = Uniform("midge", Quiet(), 1, {});
  swarm.position = {{2, 0, 0}};
  const FlockState state = After(world, {swarm}, 20);
  EXPECT_NEAR(state.position[0].x, 2 + 1.5, 0.02);  // s0 = 1.5 m/s for a second
  EXPECT_NEAR(state.position[0].y, 0, 0.02);
  EXPECT_NEAR(Norm(state.velocity[0]), 1.5, 0.02);
  const FlockState later = After(world, {swarm}, 200);
  EXPECT_LT(Norm(later.position[0] - Vec3d{10, 0, 0}), 1.5);  // there, where V_g ends
}

TEST(SwarmMotion, EverybodyComesThroughTheGapAndNobodyThroughAWall) {
  SwarmParameters p;  // curl noise
  p.cell = 0.2;
  const World world = Hall();
  Engine engine(world, {Uniform("midge", p, 150, kEntrance)}, {});
  for (int step = 0; step < 600; ++step) {
    engine.Step();
    for (const Vec3d& x : engine.State().position) {
      for (const Obstacle& obstacle : world.obstacles) {
        ASSERT_GT(SignedDistance(obstacle.solid, x), -0.1) << step;  // half a cell
      }
    }
  }
  for (const Vec3d& x : engine.State().position) {
    EXPECT_LT(Norm(x - world.goals[0].position), 2.5);
  }
  EXPECT_GT(engine.MdeShare(), 0);
}

TEST(SwarmMotion, SameBytesWithEveryKernelAndAnyThreads) {
  SwarmParameters p;
  p.cell = 0.2;
  p.evolution = 3;
  p.body_size = 0.5;
  p.crowding = 0.1;
  p.lamp_probability = 0.1;
  p.lamp_kick = 1;
  Swarm swarm = Uniform("midge", p, 3000, kEntrance);
  for (std::size_t k = 0; k < swarm.position.size(); ++k) swarm.radius.push_back(0.02);
  const FlockState expected = After(Hall(), {swarm}, 40, {.threads = 1, .kernel = "scalar"});
  const auto expect_same = [&](const EngineOptions& options) {
    const FlockState actual = After(Hall(), {swarm}, 40, options);
    EXPECT_EQ(actual.position, expected.position);
    EXPECT_EQ(actual.velocity, expected.velocity);
  };
  expect_same({.threads = 2, .kernel = ""});
  expect_same({.threads = 4, .kernel = "scalar"});
  for (const SwarmKernelVariant& variant : kSwarmKernels) {
    SCOPED_TRACE(variant.name);
    if (variant.supported()) expect_same({.threads = 1, .kernel = variant.name});
  }
  EXPECT_THROW(After(Hall(), {swarm}, 1, {.threads = 1, .kernel = "mmx"}), std::invalid_argument);
}

TEST(SwarmMotion, FloatFollowsDouble) {
  SwarmParameters p;
  p.cell = 0.2;
  const Swarm swarm = Uniform("midge", p, 400, kEntrance);
  Engine engine(Hall(), {swarm}, {});
  ReferenceEngine reference(Hall(), {swarm}, {});
  for (int step = 0; step < 20; ++step) {
    engine.Step();
    reference.Step();
  }
  const FlockState actual = engine.State(), expected = reference.State();
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_LT(Norm(actual.position[k] - expected.position[k]), 1e-3) << k;
  }
}

TEST(SwarmMotion, GoesOnFromASavedState) {
  SwarmParameters p;
  p.cell = 0.3;
  p.crowding = 0.2;
  World world = Hall();
  world.goals[0].waypoints = {{0, {10, 0, 2}}, {3, {9, 2, 1}}};
  const std::vector<Swarm> swarms = {Uniform("midge", p, 500, kEntrance)};
  Engine engine(world, swarms, {});
  for (int step = 0; step < 37; ++step) engine.Step();
  const std::string saved = engine.Save();
  Engine other(world, swarms, {});
  other.Load(saved);
  for (int step = 0; step < 40; ++step) {
    engine.Step();
    other.Step();
  }
  EXPECT_EQ(other.State().position, engine.State().position);
}

// Variance over mean of the number of animals in the cells of a lattice, which is 1 where they are
// strewn at random.
double Clumping(const std::vector<Vec3d>& position, double edge) {
  std::map<std::array<int, 3>, int> counts;
  for (const Vec3d& x : position) {
    ++counts[{static_cast<int>(std::floor(x.x / edge)), static_cast<int>(std::floor(x.y / edge)),
              static_cast<int>(std::floor(x.z / edge))}];
  }
  // Of the cells well inside, so that those which left the region do not count.
  double sum = 0, squares = 0, cells = 0;
  for (int a = 2; a < 8; ++a) {
    for (int b = 2; b < 8; ++b) {
      for (int c = 2; c < 8; ++c) {
        const auto found = counts.find({a, b, c});
        const double n = found == counts.end() ? 0 : found->second;
        sum += n;
        squares += n * n;
        cells += 1;
      }
    }
  }
  const double mean = sum / cells;
  return (squares / cells - mean * mean) / mean;
}

TEST(SwarmMotion, CurlNoiseSpreadsAnimalsEvenlyAndPerlinNoiseClumpsThem) {
  World world;
  world.dt = 1.0 / 60;
  const auto clumping = [&](SwarmNoiseKind kind) {
    const SwarmParameters p = WithNoise(kind, 0.25, 0.4);
    const Swarm swarm = Uniform("midge", p, 8000, {{0, 0, 0}, {4, 4, 4}}, 5);
    return Clumping(After(world, {swarm}, 180).position, 0.4);
  };
  const double none = clumping(SwarmNoiseKind::kNone), white = clumping(SwarmNoiseKind::kWhite),
               curl = clumping(SwarmNoiseKind::kCurl), perlin = clumping(SwarmNoiseKind::kPerlin);
  RecordProperty("none", std::to_string(none));
  RecordProperty("white", std::to_string(white));
  RecordProperty("curl", std::to_string(curl));
  RecordProperty("perlin", std::to_string(perlin));
  EXPECT_NEAR(none, 1, 0.3);  // Poisson
  EXPECT_LT(curl, 2);
  EXPECT_LT(white, 2);
  EXPECT_GT(perlin, 5 * curl);
}

TEST(SwarmMotion, WhiteNoiseDiffuses) {
  World world;
  world.dt = 0.02;
  const SwarmParameters p = WithNoise(SwarmNoiseKind::kWhite, 0.5, 0.5);
  const FlockState state = After(world, {Uniform("midge", p, 4000, {})}, 50);
  double squares = 0;
  for (const Vec3d& x : state.position) squares += SquaredNorm(x) / 4000;
  // 50 steps of 0.02 s at gain / scale = 1 m/s a component: 50 * 3 * 0.02^2.
  EXPECT_NEAR(squares, 0.06, 0.004);
}

TEST(SwarmMotion, PerlinVelocityIsABaselineOfTheSameStrength) {
  World world;
  const auto speed = [&](SwarmNoiseKind kind) {
    const SwarmParameters p = WithNoise(kind);
    const FlockState state = After(world, {Uniform("midge", p, 4000, {{0, 0, 0}, {9, 9, 9}})}, 1);
    double squares = 0;
    for (const Vec3d& v : state.velocity) squares += SquaredNorm(v) / 4000;
    return std::sqrt(squares);
  };
  const double curl = speed(SwarmNoiseKind::kCurl), perlin = speed(SwarmNoiseKind::kPerlin);
  EXPECT_GT(curl, 0.3);
  EXPECT_LT(curl, 1.2);
  EXPECT_GT(perlin, 0.2 * curl);
  EXPECT_LT(perlin, curl);
}

TEST(SwarmMotion, OpposingSwarmsReachTheirOwnGoalsAndKeepTheirDistance) {
  World world;
  world.dt = 1.0 / 30;
  world.box = {{-8, -3, 0}, {8, 3, 4}};
  world.goals = {BallGoal({6, 0, 2}, 1.2, "east"), BallGoal({-6, 0, 2}, 1.2, "west")};
  SwarmParameters p;
  p.cell = 0.25;
  p.d_min = 0.1;
  const std::vector<Swarm> swarms = {Uniform("east", p, 100, {{-7, -1, 1}, {-5, 1, 3}}, 1),
                                     Uniform("west", p, 100, {{5, -1, 1}, {7, 1, 3}}, 2)};
  Engine engine(world, swarms, {});
  double nearest = 1;
  for (int step = 0; step < 450; ++step) {
    engine.Step();
    const std::vector<Vec3d> x = engine.State().position;
    for (std::size_t i = 0; i < 100; ++i) {
      for (std::size_t j = 100; j < 200; ++j) nearest = std::min(nearest, Norm(x[i] - x[j]));
    }
  }
  EXPECT_LT(nearest, 0.2);   // they met
  EXPECT_GT(nearest, 0.03);  // one pass of enforcement a step leaves some of a crush
  const std::vector<Vec3d> x = engine.State().position;
  for (std::size_t k = 0; k < 100; ++k) {
    EXPECT_LT(Norm(x[k] - world.goals[0].position), 2.5);
    EXPECT_LT(Norm(x[100 + k] - world.goals[1].position), 2.5);
  }
}

TEST(SwarmMotion, FollowsAGoalThatMovesAndFlowsRoundASolidOne) {
  World world;
  world.dt = 1.0 / 30;
  world.box = {{0, 0, 0}, {10, 10, 6}};
  world.goals = {BallGoal({3, 3, 3}, 1)};
  world.goals[0].waypoints = {{0, {3, 3, 3}}, {6, {7, 7, 3}}};
  SwarmParameters p;
  p.cell = 0.25;
  p.goal.index = 1;
  Engine engine(world, {Uniform("midge", p, 60, {{1, 1, 2}, {2, 5, 4}})}, {});
  for (int step = 0; step < 400; ++step) engine.Step();
  for (const Vec3d& x : engine.State().position) {
    EXPECT_LT(Norm(x - Vec3d{7, 7, 3}), 2);
    EXPECT_GT(Norm(x - Vec3d{7, 7, 3}), 0.6);
  }
}

TEST(SwarmMotion, KicksGatherMothsAtTheLamp) {
  World world;
  world.dt = 1.0 / 60;
  world.box = {{-4, -4, -4}, {4, 4, 4}};
  world.goals = {BallGoal({0, 0, 0}, 3)};
  const auto spread = [&](double probability) {
    SwarmParameters p = WithNoise(SwarmNoiseKind::kCurl, 0.3, 0.4);
    p.lamp_probability = probability;
    p.lamp_kick = 1.5;
    const FlockState state =
        After(world, {Uniform("moth", p, 300, {{-2, -2, -2}, {2, 2, 2}})}, 300);
    double sum = 0;
    for (const Vec3d& x : state.position) sum += Norm(x) / 300;
    return sum;
  };
  EXPECT_LT(spread(0.5), 0.7 * spread(0));
}

TEST(SwarmMotion, CrowdsMakeOthersGoAnotherWay) {
  // Two gaps in a wall, the second one a detour for all.
  World world;
  world.dt = 1.0 / 30;
  world.box = {{0, 0, 0}, {10, 8, 3}};
  world.goals = {BallGoal({9, 2, 1.5}, 0.8)};
  world.obstacles = {BoxObstacle({5, 0, 0}, {5.6, 1.4, 3}), BoxObstacle({5, 2.6, 0}, {5.6, 4.4, 3}),
                     BoxObstacle({5, 5.6, 0}, {5.6, 8, 3})};
  const auto detours = [&](double crowding) {
    SwarmParameters p = Quiet();
    p.cell = 0.2;
    p.crowding = crowding;
    p.crowding_interval = 0.2;
    Engine engine(world, {Uniform("midge", p, 400, {{0.5, 0.5, 0.5}, {3.5, 4, 2.5}})}, {});
    int count = 0;
    std::vector<Vec3d> before = engine.State().position;
    for (int step = 0; step < 250; ++step) {
      engine.Step();
      std::vector<Vec3d> now = engine.State().position;
      for (std::size_t k = 0; k < now.size(); ++k) {
        count += before[k].x < 5.3 && now[k].x >= 5.3 && now[k].y > 4 ? 1 : 0;
      }
      before = std::move(now);
    }
    return count;
  };
  const int alone = detours(0), crowded = detours(0.05);
  EXPECT_LT(alone, 40);
  EXPECT_GT(crowded, alone + 40);
}

TEST(SwarmMotion, WindCarriesAndSlidersTurn) {
  World world;
  world.dt = 0.1;
  world.wind.velocity = {0, 2, 0};
  Swarm swarm = Uniform("midge", Quiet(), 2, {});
  swarm.spec = ModelSpec{.name = "swarm", .parameters = {}, .where = {}, .where_of = {}};
  swarm.spec.choices["noise"] = "none";
  Engine engine(world, {swarm}, {});
  for (int step = 0; step < 10; ++step) engine.Step();
  EXPECT_NEAR(engine.State().position[0].y, 2, 1e-5);
  ModelSpec change;
  change.choices["noise"] = "curl";
  engine.SetParameters("midge", change);
  engine.Step();
  EXPECT_GT(Norm(engine.State().velocity[0] - Vec3d{0, 2, 0}), 1e-3);
}

TEST(SwarmMotion, RefusesWhatItCannotDo) {
  World flat = Hall();
  flat.dimensions = 2;
  EXPECT_THROW(After(flat, {Uniform("midge", Quiet(), 3, kEntrance)}, 1), std::invalid_argument);
  World boundless;
  boundless.goals = {BallGoal({0, 0, 0}, 1)};
  EXPECT_THROW(After(boundless, {Uniform("midge", Quiet(), 3, kEntrance)}, 1),
               std::invalid_argument);
  Swarm pushed = Uniform("midge", Quiet(), 3, kEntrance);
  pushed.forces = {ModelSpec{.name = "drag", .parameters = {}, .where = "x:1", .where_of = {}}};
  EXPECT_THROW(After(Hall(), {pushed}, 1), InputError);
}

}  // namespace
}  // namespace flocklift
