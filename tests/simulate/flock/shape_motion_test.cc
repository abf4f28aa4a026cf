// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/shape_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/flock/engine.h"
#include "simulate/flock/shape_pairs.h"
#include "simulate/flock/shape_targets.h"
#include "simulate/shapes/solid_meshes.h"

namespace flocklift {
namespace {

constexpr int kCount = 400;

World BallWorld() {
  World world;
  world.dt = 1.0 / 30;
  world.shapes.push_back({"ball", {0}, {BallMesh({}, 2.4, 3)}, 0, ""});
  return world;
}

Swarm Insects(const ShapeParameters& p, int count = kCount) {
  Swarm swarm;
  swarm.species = "fly";
  swarm.model = p;
  swarm.shape = "ball";
  Rng rng(5);
  for (int k = 0; k < count; ++k) {
    swarm.position.push_back({2 * rng.Normal(), 2 * rng.Normal(), 2 * rng.Normal()});
    swarm.velocity.push_back({0.1 * rng.Normal(), 0.1 * rng.Normal(), 0.1 * rng.Normal()});
  }
  return swarm;
}

struct Figures {
  double error = 0;  // mean distance to the surface [m]
  double speed = 0;  // mean [m/s]
};

// After the swarm has had time to form the shape, means over some seconds.
Figures Settled(const World& world, const ShapeParameters& p) {
  Engine engine(world, {Insects(p)}, {});
  for (int k = 0; k < 300; ++k) engine.Step();
  Figures figures;
  for (int sample = 0; sample < 10; ++sample) {
    for (int k = 0; k < 10; ++k) engine.Step();
    const FlockState state = engine.State();
    for (std::size_t k = 0; k < state.size(); ++k) {
      figures.error += std::abs(Norm(state.position[k]) - 2.4) / (10.0 * kCount);
      figures.speed += Norm(state.velocity[k]) / (10.0 * kCount);
    }
  }
  return figures;
}

TEST(ShapeMotion, FormsTheShapeAndStaysInMotion) {
  const Figures figures = Settled(BallWorld(), {});
  RecordProperty("error_mm", static_cast<int>(1000 * figures.error));
  RecordProperty("speed_mm_s", static_cast<int>(1000 * figures.speed));
  EXPECT_LT(figures.error, 0.5);
  EXPECT_GT(figures.speed, 0.05);
  EXPECT_LE(figures.speed, 0.75 + 1e-5);
  // Where only the shape acts, against drag, they stick to it.
  const Figures stuck = Settled(BallWorld(), {.alpha = 0, .drag = 2});
  RecordProperty("stuck_speed_mm_s", static_cast<int>(1000 * stuck.speed));
  EXPECT_LT(stuck.speed, 0.3 * figures.speed);
  EXPECT_LT(stuck.error, figures.error);
}

TEST(ShapeMotion, ErrorGrowsWithAlphaAndFallsWithTheDistanceForce) {
  const World world = BallWorld();
  const auto error = [&](const char* name, const ShapeParameters& p) {
    const Figures figures = Settled(world, p);
    RecordProperty(std::string(name) + "_mm", static_cast<int>(1000 * figures.error));
    return figures.error;
  };
  const double at_7 = error("alpha_7", {.alpha = 0.7});
  EXPECT_LT(error("alpha_4", {.alpha = 0.4}), at_7);
  EXPECT_GT(error("alpha_9", {.alpha = 0.9}), at_7);
  EXPECT_LT(error("w_dis_16", {.alpha = 0.7, .w_dis = 16}), at_7);
}

TEST(ShapeMotion, NeighboursAreAboutAsManyAsTheCap) {
  for (const double cap : {8.0, 24.0}) {
    Engine engine(BallWorld(), {Insects({.neighbours = cap})}, {});
    for (int k = 0; k < 200; ++k) engine.Step();
    const double sum = engine.MeanNeighbours() * 200;
    for (int k = 0; k < 100; ++k) engine.Step();
    EXPECT_NEAR((engine.MeanNeighbours() * 300 - sum) / 100, cap, 0.2 * cap);
  }
  // As published everybody is within 10 m.
  Engine engine(BallWorld(), {Insects({.neighbours = 0})}, {});
  engine.Step();
  EXPECT_NEAR(engine.MeanNeighbours(), kCount - 1, 1);
}

TEST(ShapeMotion, PairsAreTheirTerms) {
  const ShapeParameters p;
  const ShapePairNumbers n = MakeShapePairNumbers(p, 0.3, 2.0);
  EXPECT_EQ(n.r_ali, 2);
  EXPECT_EQ(n.r_att, 2);
  EXPECT_EQ(Reach(n), 2);
  const ShapePairs<double> pairs = MakeShapePairs<double>(n);
  const std::pair<Vec3d, Vec3d> others[] = {{{0.1, 0, 0}, {0, 0, 1}},   // repels and spreads
                                            {{0, 1.0, 0}, {0, 0, 2}},   // aligns
                                            {{0, 0, 3.0}, {0, 1, 0}}};  // too far
  ShapePairs<double>::Sums sums;
  for (const auto& [dx, dv] : others) pairs.Add(dx, dv, &sums);
  EXPECT_EQ(sums.Neighbours(), 2);
  EXPECT_EQ(sums.spread.weight, 1);
  EXPECT_EQ(sums.attract.weight, 0);  // nobody is
  const Vec3d a = pairs.Finish(sums);
  const double spread = 0.3 * ShapeForce::Fall(0.5 * std::pow(0.1 / 0.27, 2));
  EXPECT_NEAR(a.x, -0.7 * 0.2 - spread, 1e-6);
  EXPECT_NEAR(a.y, 0, 1e-12);
  EXPECT_NEAR(a.z, 0.7 * 3, 1e-6);
}

TEST(ShapeMotion, GoesAroundAnObstacle) {
  World world = BallWorld();
  world.obstacles.push_back({BallMesh({2.4, 0, 0}, 1, 3), Ball{{2.4, 0, 0}, 1}});
  Swarm swarm = Insects({});
  for (Vec3d& x : swarm.position) {
    const Vec3d way = x - Vec3d{2.4, 0, 0};
    if (Norm(way) < 1.1) x = Vec3d{2.4, 0, 0} + 1.1 * Normalized(way);
  }
  Engine engine(world, {swarm}, {});
  for (int k = 0; k < 400; ++k) engine.Step();
  for (const Vec3d& x : engine.State().position) {
    // The distance is that of a grid with four nodes a range; enforcement may push by d_min.
    EXPECT_GT(Norm(x - Vec3d{2.4, 0, 0}), 0.9);
  }
}

TEST(ShapeMotion, FollowsThePath) {
  World world = BallWorld();
  world.shapes[0].path = "way";
  world.paths.push_back({"way", {{0, 0, 0}, {20, 0, 0}}, 1, 0});
  Engine engine(world, {Insects({})}, {});
  for (int k = 0; k < 450; ++k) engine.Step();
  Vec3d center;
  for (const Vec3d& x : engine.State().position) center += x / kCount;
  EXPECT_NEAR(center.x, 15, 1);  // 15 s at 1 m/s
  EXPECT_NEAR(center.y, 0, 0.5);
}

TEST(ShapeMotion, SameBytesAtAnyNumberOfThreadsAndAfterACheckpoint) {
  const World world = BallWorld();
  const Swarm insects = Insects({}, 2600);  // more than one chunk of work
  Engine one(world, {insects}, {.threads = 1, .kernel = {}});
  Engine two(world, {insects}, {.threads = 2, .kernel = {}});
  Engine resumed(world, {insects}, {.threads = 1, .kernel = {}});
  for (int k = 0; k < 30; ++k) {
    one.Step();
    two.Step();
  }
  resumed.Load(one.Save());
  for (int k = 0; k < 20; ++k) {
    one.Step();
    two.Step();
    resumed.Step();
  }
  EXPECT_EQ(one.State().position, two.State().position);
  EXPECT_EQ(one.State().velocity, two.State().velocity);
  EXPECT_EQ(one.State().position, resumed.State().position);
  EXPECT_EQ(one.State().velocity, resumed.State().velocity);
}

TEST(ShapeMotion, FloatFollowsDouble) {
  Engine engine(BallWorld(), {Insects({})}, {});
  ReferenceEngine reference(BallWorld(), {Insects({})}, {});
  engine.Step();
  reference.Step();
  const std::vector<Vec3d> actual = engine.Accelerations(), expected = reference.Accelerations();
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_LT(Norm(actual[k] - expected[k]), 1e-3 * (1 + Norm(expected[k]))) << k;
  }
}

TEST(ShapeMotion, NeedsAShape) {
  Swarm swarm = Insects({});
  swarm.shape = "cube";
  EXPECT_THROW(Engine(BallWorld(), {swarm}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
