// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/bswarm_motion.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/simulate/flock/motion_checks.h"

namespace flocklift {
namespace {

// The zones and nothing else.
BSwarmParameters Plain(const ZoneParameters& zones) {
  BSwarmParameters p;
  p.zones = zones;
  p.drive = p.curl_gain = p.noise = p.alpha_b = 0;
  p.s_max = 1e6;
  p.avoid.index = static_cast<int>(Avoidance::kNone);
  return p;
}

Vec3d Unit(const Vec3d& v) { return Norm(v) > 1e-9 ? v / Norm(v) : Vec3d{}; }

// Equations 2 and 3 of Chen et al. 2019.
Vec3d ThreeZones(const NamedFlock& flock, std::size_t k, const ZoneParameters& z) {
  Vec3d sum[3];
  int count[3] = {};
  for (std::size_t j = 0; j < flock.position.size(); ++j) {
    if (j == k) continue;
    const Vec3d r = flock.position[j] - flock.position[k];
    const Vec3d u = flock.velocity[j] - flock.velocity[k];
    const double distance = Norm(r);
    if (distance > z.r_att) continue;
    const int zone = distance < z.r_rep ? 0 : distance < z.r_ali ? 1 : 2;
    sum[zone] += zone == 0 ? -Unit(r) : zone == 1 ? Unit(u) : Unit(r);
    ++count[zone];
  }
  const double weight[3] = {z.w_rep, z.w_ali, z.w_att};
  Vec3d force;
  for (int zone = 0; zone < 3; ++zone) {
    if (count[zone] > 0) force += (weight[zone] / count[zone]) * sum[zone];
  }
  return force;
}

TEST(BSwarmMotion, TheZonesAreThePublishedOnes) {
  const NamedFlock flock = RandomFlock("", 300, {5, 5, 5}, 51);
  const ZoneParameters zones{0.8, 2, 4, 0.2, 3, 13, 0};
  BSwarmParameters p = Plain(zones);
  for (const double most : {0.0, 1e5}) {  // and a sample of all is all
    p.most = most;
    ReferenceEngine engine(World{}, {AsSwarm(flock, p)}, {});
    engine.Step();
    const auto accelerations = engine.Accelerations();
    for (std::size_t k = 0; k < 300; ++k) {
      EXPECT_LT(Norm(accelerations[k] - ThreeZones(flock, k, zones)), 1e-6) << k;
    }
  }
}

// A sample thins alignment and attraction, and never repulsion.
TEST(BSwarmMotion, ASampleHearsEverybodyNear) {
  const NamedFlock flock = RandomFlock("", 1000, {6, 6, 6}, 52);
  ZoneParameters zones{0.8, 10, 30, 0.2, 0, 0, 0};
  BSwarmParameters p = Plain(zones);
  p.most = 20;
  ReferenceEngine repelled(World{}, {AsSwarm(flock, p)}, {});
  repelled.Step();
  const auto accelerations = repelled.Accelerations();
  for (std::size_t k = 0; k < 1000; ++k) {
    EXPECT_LT(Norm(accelerations[k] - ThreeZones(flock, k, zones)), 1e-6) << k;
  }
  EXPECT_LT(repelled.MeanNeighbours(), 40);
  EXPECT_GT(repelled.MeanNeighbours(), 20);
}

TEST(BSwarmMotion, SameBytesAtAnyThreadCountAndWithAnyKernel) {
  BSwarmParameters p;
  p.zones = {0.5, 1, 2, 0.2, 3, 13, 0};
  p.noise = 1;
  p.s_max = 5;
  ExpectSameBytesEverywhere(p);
  p.most = 30;
  p.zones = {0.5, 10, 30, 0.2, 3, 13, 0};
  ExpectSameBytesEverywhere(p);
}

// Everybody to the middle; how near any two come.
double LeastDistance(Avoidance avoid, int dimensions) {
  World world;
  world.dt = 1.0 / 60;
  world.dimensions = dimensions;
  world.goals = {{.species = "", .position = {0, 0, 0}}};
  BSwarmParameters p = Plain({0.1, 0.2, 0.3, 0, 0, 0, 0});
  p.avoid.index = static_cast<int>(avoid);
  p.drive = 2;
  p.s_max = 1;
  p.sight = 1;
  p.horizon = 0.5;
  Swarm swarm = AsSwarm(RandomFlock("", 60, {0, 0, 0}, 53), p);
  Rng rng(54);
  for (std::size_t k = 0; k < 60; ++k) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(k) / 60;
    swarm.position[k] = {4 * std::cos(turn), 4 * std::sin(turn), 0.2 * rng.Normal()};
    swarm.velocity[k] = -0.1 * swarm.position[k];
  }
  swarm.cruising_speed.assign(60, 0.8);
  swarm.radius.assign(60, 0.1);
  Engine engine(world, {swarm}, {});
  double least = 1e9;
  for (int step = 0; step < 400; ++step) {
    engine.Step();
    const FlockState state = engine.State();
    for (std::size_t k = 0; k < 60; ++k) {
      for (std::size_t j = 0; j < k; ++j) {
        least = std::min(least, Norm(state.position[k] - state.position[j]));
      }
    }
  }
  return least;
}

TEST(BSwarmMotion, VelocityObstaclesKeepBodiesApart) {
  EXPECT_GT(LeastDistance(Avoidance::kOrca, 3), 0.2 * 0.97);
  EXPECT_GT(LeastDistance(Avoidance::kOrca, 2), 0.2 * 0.9);
  const double left_alone = LeastDistance(Avoidance::kNone, 3);
  EXPECT_LT(left_alone, 0.1);
  EXPECT_GT(LeastDistance(Avoidance::kDistance, 3), left_alone);  // one pass a step, as published
}

TEST(BSwarmMotion, ObstaclesAreNotEntered) {
  World world;
  world.dt = 1.0 / 60;
  world.goals = {{.species = "", .position = {10, 0, 0}}};
  world.obstacles.push_back({{}, Ball{{3, 0, 0}, 1.5}});
  BSwarmParameters p = Plain({0.1, 0.2, 0.3, 0, 0, 0, 0});
  p.avoid.index = static_cast<int>(Avoidance::kOrca);
  p.drive = 2;
  p.s_max = 1.5;
  p.sight = 1.5;
  Swarm swarm = AsSwarm(RandomFlock("", 40, {2, 2, 2}, 55), p);
  for (Vec3d& x : swarm.position) x += Vec3d{-2, -1, -1};
  swarm.cruising_speed.assign(40, 1.2);
  swarm.radius.assign(40, 0.05);
  Engine engine(world, {swarm}, {});
  double least = 1e9, way = 0;
  for (int step = 0; step < 700; ++step) {
    engine.Step();
    for (const Vec3d& x : engine.State().position) {
      least = std::min(least, Norm(x - Vec3d{3, 0, 0}) - 1.5);
    }
  }
  for (const Vec3d& x : engine.State().position) way += x.x / 40;
  EXPECT_GT(least, 0.04);
  EXPECT_GT(way, 6);  // and they got past it
}

// Buhl et al. 2006: in one arena and at one noise, order comes with density.
TEST(BSwarmMotion, OrderComesWithDensity) {
  const auto order = [](int count) {
    double sum = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      BSwarmParameters p = Plain({0.1, 1, 1, 0, 3, 0, 0});
      p.noise = 1.5;
      p.drive = 4;
      p.s_max = 1;
      p.alpha_b = 3;
      p.wall_taper = 1;
      World world;
      world.seed = seed;
      world.dt = 1.0 / 30;
      world.box = {{0, 0, 0}, {6, 6, 6}};
      Swarm swarm = AsSwarm(RandomFlock("", count, {6, 6, 6}, 56 + seed), p);
      swarm.cruising_speed.assign(swarm.position.size(), 0.5);
      Engine engine(world, {swarm}, {});
      for (int step = 0; step < 500; ++step) {
        engine.Step();
        if (step >= 200) sum += Polarization(engine.State()) / (3 * 300);
      }
    }
    return sum;
  };
  const double few = order(15), many = order(480);
  EXPECT_LT(few, 0.6);
  EXPECT_GT(many, 0.65);
  EXPECT_GT(many, few + 0.2);
}

}  // namespace
}  // namespace flocklift
