// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/crowd_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "simulate/core/check.h"
#include "simulate/core/rng.h"
#include "simulate/flock/engine.h"
#include "simulate/shapes/solid_meshes.h"

namespace flocklift {
namespace {

CrowdParameters WithNoise(SwarmNoiseKind kind, double gain = 0.25, double scale = 0.4) {
  CrowdParameters p;
  p.d_min = 0;
  p.noise.index = static_cast<int>(kind);
  p.gain = gain;
  p.scale = scale;
  return p;
}

Swarm Uniform(const CrowdParameters& p, int count, const Region& region) {
  Swarm swarm;
  swarm.species = "walker";
  swarm.model = p;
  Rng rng(4);
  for (int k = 0; k < count; ++k) {
    swarm.position.push_back({rng.Uniform(region.low.x, region.high.x),
                              rng.Uniform(region.low.y, region.high.y),
                              rng.Uniform(region.low.z, region.high.z)});
    swarm.velocity.push_back({});
  }
  return swarm;
}

GoalSpec BallGoal(const Vec3d& position, double reach, const std::string& species = "") {
  GoalSpec goal;
  goal.species = species;
  goal.position = position;
  goal.reach = reach;
  return goal;
}

Obstacle BoxObstacle(const Vec3d& low, const Vec3d& high) {
  return {BoxMesh(low, high), Block{low, high}};
}

// A square with a block in the middle and a goal at either end; the ground is at 0.2.
World Square() {
  World world;
  world.dt = 0.05;
  world.box = {{-16, -8, 0}, {16, 8, 0.4}};
  world.goals = {BallGoal({13, 0, 0}, 2.5), BallGoal({-13, 0, 0}, 2.5)};
  world.obstacles.push_back(BoxObstacle({-1, -2, -2}, {1, 2, 2}));
  return world;
}

// Groups that face each other across the square, each in front of the other's goal.
Swarm FacingGroups(const CrowdParameters& p, int count) {
  Swarm swarm = Uniform(p, count, {{-14, -5, 0}, {-4, 5, 0.4}});
  for (std::size_t k = 1; k < swarm.position.size(); k += 2) swarm.position[k].x *= -1;
  return swarm;
}

TEST(CrowdMotion, EverybodyWalksToTheGoalOfTheirGroup) {
  World world = Square();
  world.obstacles.clear();
  world.goals = {BallGoal({13, 0, 0}, 1), BallGoal({0, 7, 0}, 1, "walker"),
                 BallGoal({0, 0, 0}, 1, "others"), BallGoal({-13, 0, 0}, 1)};
  CrowdParameters p;
  p.field.max_speed = 1.5;
  Swarm swarm = Uniform(p, 6, {});
  swarm.position = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {3, 0, 0}, {0, -5, 0.4}, {-5, 0, 0}};
  Engine engine(world, {swarm}, {});
  EXPECT_EQ(engine.State().position[1], (Vec3d{0, 1, 0.2F}));  // on the ground from the start
  for (int step = 0; step < 10; ++step) engine.Step();
  const FlockState soon = engine.State();
  EXPECT_NEAR(soon.position[0].x, 1 + 0.75, 0.02);  // half a second at f_max
  EXPECT_NEAR(soon.position[1].y, 1 + 0.75, 0.02);
  EXPECT_NEAR(soon.position[2].x, -1 - 0.75, 0.02);
  for (int step = 0; step < 400; ++step) engine.Step();
  const std::array<Vec3d, 3> goals = {{{13, 0, 0.2}, {0, 7, 0.2}, {-13, 0, 0.2}}};
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_LT(Norm(engine.State().position[k] - goals[k % 3]), 1.2) << k;
    EXPECT_FLOAT_EQ(engine.State().position[k].z, 0.2F) << k;
  }
}

// Mean over animals of ((a - b) / (a + b))^2, a and b how many of its own and of the other group
// are in the animal's strip of a metre along y (M. Rex, H. Loewen, Phys. Rev. E 75 (2007) 051402),
// of those between the goals.
double LaneOrder(const std::vector<Vec3d>& positions) {
  std::map<int, std::array<double, 2>> strips;
  double count = 0, sum = 0;
  for (std::size_t k = 0; k < positions.size(); ++k) {
    if (std::abs(positions[k].x) > 9) continue;
    ++strips[static_cast<int>(std::floor(positions[k].y))][k % 2];
    ++count;
  }
  for (const auto& [strip, group] : strips) {
    sum += std::pow(group[0] - group[1], 2) / (group[0] + group[1]);
  }
  return count > 0 ? sum / count : 0;
}

struct Crossing {
  double lane_order = 0;    // mean while the groups pass each other
  double half_there = 0;    // when half of all have arrived [s]
  double arrived = 0;       // share at the end
  double least_clear = 99;  // of an animal from the block [m]
  double nearest = 99;      // of two animals, at the end [m]
};

Crossing Cross(const CrowdParameters& p, int steps) {
  const World world = Square();
  Engine engine(world, {FacingGroups(p, 160)}, {});
  Crossing result;
  int passing = 0;
  for (int step = 0; step < steps; ++step) {
    engine.Step();
    const std::vector<Vec3d> x = engine.State().position;
    result.arrived = 0;
    double middle = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double forward = k % 2 == 0 ? x[k].x : -x[k].x;
      if (forward > 9) result.arrived += 1.0 / 160;
      if (std::abs(x[k].x) < 9) middle += 1.0 / 160;
      result.least_clear =
          std::min(result.least_clear, SignedDistance(world.obstacles[0].solid, x[k]));
    }
    if (result.half_there == 0 && result.arrived >= 0.5) result.half_there = step * world.dt;
    if (result.arrived < 0.5 && step >= 100 && middle > 0.3) {
      result.lane_order += LaneOrder(x);
      ++passing;
    }
  }
  result.lane_order /= passing;
  const std::vector<Vec3d> x = engine.State().position;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      result.nearest = std::min(result.nearest, Norm(x[i] - x[j]));
  }
  return result;
}

TEST(CrowdMotion, GroupsPassEachOtherInLanesAndRoundTheBlock) {
  const CrowdParameters p;
  CrowdParameters blind = p;  // nobody is ever a crowd to these
  blind.field.density_low = 1e6;
  blind.field.density_high = 2e6;
  const Crossing crowd = Cross(p, 1200), alone = Cross(blind, 1200);
  RecordProperty("lane_order", std::to_string(crowd.lane_order));
  RecordProperty("lane_order_blind", std::to_string(alone.lane_order));
  RecordProperty("half_there_s", std::to_string(crowd.half_there));
  RecordProperty("half_there_blind_s", std::to_string(alone.half_there));
  RecordProperty("arrived", std::to_string(crowd.arrived));
  RecordProperty("least_clear_m", std::to_string(crowd.least_clear));
  RecordProperty("nearest_m", std::to_string(crowd.nearest));
  EXPECT_GT(crowd.lane_order, alone.lane_order + 0.1);
  EXPECT_GT(crowd.arrived, 0.95);
  EXPECT_GT(crowd.least_clear, -0.75);  // half a cell, and a push of half of d_min
  EXPECT_GT(crowd.nearest, 0.2);        // one pass of enforcement a step leaves some of a crush
}

TEST(CrowdMotion, SameBytesAtAnyThreadCountAndFromASavedState) {
  CrowdParameters p = WithNoise(SwarmNoiseKind::kCurl, 0.3, 2);
  p.d_min = 0.5;
  p.evolution = 4;
  World world = Square();
  world.goals[0].waypoints = {{0, {13, 0, 0}}, {3, {10, 5, 0}}};
  const std::vector<Swarm> swarms = {FacingGroups(p, 200)};
  Engine one(world, swarms, {.threads = 1, .kernel = ""});
  Engine two(world, swarms, {.threads = 2, .kernel = ""});
  for (int step = 0; step < 37; ++step) {  // in the middle of an interval
    one.Step();
    two.Step();
  }
  Engine resumed(world, swarms, {});
  resumed.Load(one.Save());
  for (int step = 0; step < 40; ++step) {
    for (Engine* engine : {&one, &two, &resumed}) engine->Step();
  }
  EXPECT_EQ(two.State().position, one.State().position);
  EXPECT_EQ(two.State().velocity, one.State().velocity);
  EXPECT_EQ(resumed.State().position, one.State().position);
  EXPECT_EQ(resumed.MdeShare(), one.MdeShare());
  Engine fewer(world, {FacingGroups(p, 100)}, {});
  EXPECT_THROW(fewer.Load(one.Save()), std::runtime_error);
}

TEST(CrowdMotion, FloatFollowsDouble) {
  CrowdParameters p;
  p.d_min = 0;
  Engine engine(Square(), {FacingGroups(p, 100)}, {});
  ReferenceEngine reference(Square(), {FacingGroups(p, 100)}, {});
  for (int step = 0; step < 20; ++step) {
    engine.Step();
    reference.Step();
  }
  for (std::size_t k = 0; k < 100; ++k) {
    EXPECT_LT(Norm(engine.State().position[k] - reference.State().position[k]), 1e-3) << k;
  }
}

TEST(CrowdMotion, FollowsAGoalThatJumps) {
  World world = Square();
  world.obstacles.clear();
  world.goals.pop_back();
  Engine engine(world, {Uniform(CrowdParameters{}, 20, {{-3, -3, 0}, {3, 3, 0.4}})}, {});
  for (int step = 0; step < 100; ++step) engine.Step();
  for (const Vec3d& v : engine.State().velocity) EXPECT_GT(v.x, 0.5);
  engine.MoveGoal(0, {-13, 0, 0});
  for (int step = 0; step < 700; ++step) engine.Step();
  for (const Vec3d& x : engine.State().position) EXPECT_LT(Norm(x - Vec3d{-13, 0, 0.2}), 4);
}

TEST(CrowdMotion, SpaceIsASquareWithAnotherAxis) {
  World world;
  world.dt = 0.05;
  world.box = {{0, 0, 0}, {8, 8, 8}};
  world.goals = {BallGoal({6.5, 6.5, 6.5}, 1)};
  world.obstacles.push_back(BoxObstacle({3, 3, 0}, {5, 5, 6}));
  CrowdParameters p;
  p.cell = 0.5;
  p.d_min = 0.1;
  Engine engine(world, {Uniform(p, 60, {{0.5, 0.5, 0.5}, {2.5, 2.5, 2.5}})}, {});
  for (int step = 0; step < 500; ++step) {
    engine.Step();
    for (const Vec3d& x : engine.State().position) {
      ASSERT_GT(SignedDistance(world.obstacles[0].solid, x), -0.25);  // half a cell
    }
  }
  for (const Vec3d& x : engine.State().position) EXPECT_LT(Norm(x - Vec3d{6.5, 6.5, 6.5}), 2);
}

// Everybody where their goal is: the noise is all there is.
World Everywhere(double size, double height) {
  World world;
  world.dt = 1.0 / 60;
  world.box = {{-4, -4, 0}, {size + 4, size + 4, height}};
  world.goals = {BallGoal({size / 2, size / 2, 0}, 4 * size)};
  return world;
}

// Variance over mean of the number of animals in squares, 1 where they are strewn at random.
double Clumping(const std::vector<Vec3d>& positions, int squares, double edge) {
  std::vector<double> counts(static_cast<std::size_t>(squares) * squares);
  for (const Vec3d& x : positions) {
    const double a = std::floor(x.x / edge), b = std::floor(x.y / edge);
    if (std::min(a, b) < 0 || std::max(a, b) >= squares) continue;
    ++counts[static_cast<std::size_t>(a) * squares + static_cast<std::size_t>(b)];
  }
  double sum = 0, square_sum = 0;
  for (const double n : counts) {
    sum += n;
    square_sum += n * n;
  }
  const double mean = sum / static_cast<double>(counts.size());
  return (square_sum / static_cast<double>(counts.size()) - mean * mean) / mean;
}

TEST(CrowdMotion, NoiseOnTheGroundStaysThereAndCurlHasNoSinks) {
  const auto clumping = [](SwarmNoiseKind kind) {
    const World world = Everywhere(8, 0.4);
    Engine engine(world, {Uniform(WithNoise(kind), 6000, {{0, 0, 0}, {8, 8, 0.4}})}, {});
    for (int step = 0; step < 180; ++step) engine.Step();
    for (const Vec3d& x : engine.State().position) EXPECT_FLOAT_EQ(x.z, 0.2F);
    std::vector<Vec3d> inner = engine.State().position;
    for (Vec3d& x : inner) x = x - Vec3d{1, 1, 0};
    return Clumping(inner, 15, 0.4);
  };
  const double none = clumping(SwarmNoiseKind::kNone), white = clumping(SwarmNoiseKind::kWhite),
               curl = clumping(SwarmNoiseKind::kCurl), perlin = clumping(SwarmNoiseKind::kPerlin);
  RecordProperty("none", std::to_string(none));
  RecordProperty("white", std::to_string(white));
  RecordProperty("curl", std::to_string(curl));
  RecordProperty("perlin", std::to_string(perlin));
  EXPECT_NEAR(none, 1, 0.3);  // Poisson
  EXPECT_LT(white, 2);
  EXPECT_LT(curl, 2);
  EXPECT_GT(perlin, 5 * curl);
}

TEST(CrowdMotion, WhiteNoiseDiffusesInAllDirectionsThereAre) {
  for (const double height : {0.4, 8.0}) {
    World world = Everywhere(0, height);
    world.goals = {BallGoal({0, 0, height / 2}, 20)};
    world.dt = 0.02;
    const CrowdParameters p = WithNoise(SwarmNoiseKind::kWhite, 0.5, 0.5);
    const Vec3d middle{0, 0, height / 2};
    Engine engine(world, {Uniform(p, 4000, {middle, middle})}, {});
    for (int step = 0; step < 50; ++step) engine.Step();
    double squares = 0;
    for (const Vec3d& x : engine.State().position) squares += SquaredNorm(x - middle) / 4000;
    // 50 steps of 0.02 s at gain / scale = 1 m/s a component.
    EXPECT_NEAR(squares, (height > 1 ? 3 : 2) * 0.02, 0.003);
  }
}

TEST(CrowdMotion, CurlNoiseTurnsAtWalls) {
  World world;
  world.dt = 0.02;
  world.box = {{0, 0, 0}, {6, 6, 0.4}};
  world.goals = {BallGoal({3, 3, 0}, 20)};
  Engine engine(
      world,
      {Uniform(WithNoise(SwarmNoiseKind::kCurl, 1.5, 1.5), 500, {{0.2, 0.2, 0}, {5.8, 5.8, 0.4}})},
      {});
  for (int step = 0; step < 500; ++step) {
    engine.Step();
    for (const Vec3d& x : engine.State().position) {
      ASSERT_GT(std::min({x.x, x.y, 6 - x.x, 6 - x.y}), -0.1) << step;
    }
  }
}

TEST(CrowdMotion, SlidersWindAndTwoDimensions) {
  World world = Square();
  world.dimensions = 2;
  world.wind.velocity = {0, 0.3, 1};
  Swarm swarm = Uniform(CrowdParameters{}, 1, {});
  swarm.spec = ModelSpec{.name = "crowd", .parameters = {}, .where = {}, .where_of = {}};
  swarm.position = {{3, 5, 0}};
  Engine engine(world, {swarm}, {});
  engine.Step();
  const Vec3d before = engine.State().velocity[0];
  EXPECT_EQ(before.z, 0);
  ModelSpec change;
  change.parameters["f_max"] = 2;
  engine.SetParameters("walker", change);
  engine.Step();
  const Vec3d v = engine.State().velocity[0] - Vec3d{0, 0.3, 0};
  EXPECT_NEAR(Norm(v) / Norm(before - Vec3d{0, 0.3, 0}), 2, 0.1);
}

TEST(CrowdMotion, RefusesWhatItCannotDo) {
  const Swarm swarm = Uniform(CrowdParameters{}, 3, {});
  World aimless = Square();
  aimless.goals = {BallGoal({0, 0, 0}, 1, "others")};
  EXPECT_THROW(Engine(aimless, {swarm}, {}), std::invalid_argument);
  World boundless;
  boundless.goals = {BallGoal({0, 0, 0}, 1)};
  EXPECT_THROW(Engine(boundless, {swarm}, {}), std::invalid_argument);
  CrowdParameters p;
  p.field.density_high = p.field.density_low;
  EXPECT_THROW(Engine(Square(), {Uniform(p, 3, {})}, {}), std::invalid_argument);
  Swarm pushed = swarm;
  pushed.forces = {ModelSpec{.name = "drag", .parameters = {}, .where = "x:1", .where_of = {}}};
  EXPECT_THROW(Engine(Square(), {pushed}, {}), InputError);
}

}  // namespace
}  // namespace flocklift
