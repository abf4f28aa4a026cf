// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/force_passes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulate/core/check.h"
#include "simulate/fields/curl_noise.h"
#include "simulate/flock/engine.h"
#include "simulate/flock/force_types.h"
#include "tests/simulate/flock/flocks.h"

namespace flocklift {
namespace {

ModelSpec Force(const std::string& type, const std::map<std::string, double>& parameters = {}) {
  return {.name = type, .parameters = parameters, .where = {}, .where_of = {}};
}

Swarm Driven(const NamedFlock& flock, const std::vector<ModelSpec>& forces) {
  Swarm swarm = AsSwarm(flock, ForcesParameters{.s_min = 0, .s_max = 1e6});
  swarm.forces = forces;
  return swarm;
}

// The acceleration of one animal at `x` with velocity `v`.
Vec3d Alone(const World& world, const ModelSpec& force, const Vec3d& x, const Vec3d& v) {
  ReferenceEngine engine(world, {Driven({"", {x}, {v}}, {force})}, {});
  engine.Step();
  return engine.Accelerations()[0];
}

void ExpectNear(const Vec3d& a, const Vec3d& b) { EXPECT_LT(Norm(a - b), 1e-9); }

TEST(ForcePasses, ThreeRulesAsTermsAreBoids) {
  const NamedFlock flock = RandomFlock("", 300, {10, 10, 10}, 3);
  for (const double taper : {0.0, 0.7}) {
    World world;
    const BoidsParameters<double> p = PlainRules(1.5, 3, taper);
    ReferenceEngine boids(world, {AsSwarm(flock, p)}, {});
    ReferenceEngine terms(
        world,
        {Driven(flock,
                {Force("separation", {{"gain", p.alpha_s}, {"radius", p.d_s}, {"taper", taper}}),
                 Force("cohesion", {{"gain", p.alpha_c}, {"radius", p.d_v}, {"taper", taper}}),
                 Force("alignment", {{"gain", p.alpha_a}, {"radius", p.d_v}, {"taper", taper}})})},
        {});
    for (int k = 0; k < 5; ++k) {
      boids.Step();
      terms.Step();
    }
    const auto expected = boids.Accelerations(), actual = terms.Accelerations();
    double most = 0;
    for (std::size_t k = 0; k < expected.size(); ++k) {
      EXPECT_LT(Norm(actual[k] - expected[k]), 1e-9);
      most = std::max(most, Norm(expected[k]));
    }
    EXPECT_GT(most, 0.1);
    EXPECT_EQ(boids.MeanNeighbours(), terms.MeanNeighbours());
  }
}

TEST(ForcePasses, TermsAddToAModelsOwn) {
  World world;
  const NamedFlock flock = RandomFlock("", 100, {10, 10, 10}, 3);
  Swarm plain = AsSwarm(flock, PlainRules(1, 3)), heavy = plain;
  heavy.forces = {Force("gravity", {{"g", 2}}), Force("drag", {{"rate", 0.5}})};
  ReferenceEngine a(world, {plain}, {}), b(world, {heavy}, {});
  a.Step();
  b.Step();
  for (std::size_t k = 0; k < 100; ++k) {
    ExpectNear(b.Accelerations()[k] - a.Accelerations()[k],
               Vec3d{0, 0, -2} - 0.5 * flock.velocity[k]);
  }
}

TEST(ForcePasses, AgentTermsByHand) {
  World world;
  world.dt = 0.5;
  world.wind.velocity = {3, 0, 0};
  world.box = {{-1, -1, -1}, {1, 1, 1}};
  world.goals = {{.species = "", .position = {4, 0, 0}, .weight = 0.5}};
  const Vec3d x{2, 0, 0}, v{0, 2, 1};
  ExpectNear(Alone(world, Force("wind", {{"rate", 2}}), x, v), {6, -4, -2});
  ExpectNear(Alone(world, Force("drag", {{"rate", 3}}), x, v), {0, -6, -3});
  ExpectNear(Alone(world, Force("gravity"), x, v), {0, 0, -9.81});
  ExpectNear(Alone(world, Force("level", {{"rate", 2}}), x, v), {0, 0, -2});
  ExpectNear(Alone(world, Force("walls", {{"gain", 7}, {"taper", 0}}), x, v), {-7, 0, 0});
  ExpectNear(Alone(world, Force("goal", {{"range", 1e6}}), x, v), {1, 0, 0});
  ExpectNear(Alone(world, Force("cruise", {{"rate", 1}}), x, v), {0, 0, 0});  // at its own speed
}

TEST(ForcePasses, NoiseFieldsAreThoseOfTheFieldsRoom) {
  World world;
  world.seed = 5;
  const Vec3d x{2.3, 0.4, -1.7};
  const NoiseTerm<double> field{0.7, 1.3, 5};
  ExpectNear(Alone(world, Force("curl", {{"gain", 0.7}, {"scale", 1.3}}), x, {}),
             CurlNoise(field, x));
  ExpectNear(Alone(world, Force("perlin", {{"gain", 0.7}, {"scale", 1.3}}), x, {}),
             PerlinVelocity(field, x));
  EXPECT_GT(Norm(CurlNoise(field, x)), 0.01);
}

TEST(ForcePasses, RepulsionFallsWithThePowerOfDistance) {
  World world;
  const NamedFlock pair{"", {{0, 0, 0}, {2, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}};
  for (const double exponent : {0.0, 1.0, 2.0}) {
    ReferenceEngine engine(
        world,
        {Driven(pair, {Force("repulsion", {{"gain", 3}, {"radius", 5}, {"exponent", exponent}})})},
        {});
    engine.Step();
    EXPECT_NEAR(engine.Accelerations()[1].x, 3 / std::pow(2, exponent), 1e-9);
    EXPECT_NEAR(engine.Accelerations()[0].x, -3 / std::pow(2, exponent), 1e-9);
  }
}

TEST(ForcePasses, NoiseHasItsStandardDeviationAndMemory) {
  World world;
  world.dt = 0.1;
  const NamedFlock flock = RandomFlock("", 2000, {10, 10, 10}, 3);
  ReferenceEngine engine(world, {Driven(flock, {Force("noise", {{"sd", 2}, {"time", 0.5}})})}, {});
  for (int k = 0; k < 30; ++k) engine.Step();
  const auto before = engine.Accelerations();
  engine.Step();
  const auto after = engine.Accelerations();
  double square = 0, product = 0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    square += SquaredNorm(after[k]) / 6000;
    product += Dot(after[k], before[k]) / 6000;
  }
  EXPECT_NEAR(std::sqrt(square), 2, 0.1);
  EXPECT_NEAR(product / square, std::exp(-0.2), 0.05);
}

TEST(ForcePasses, WrongTermsAndModelsThatTakeNoneAreInputErrors) {
  World world;
  const NamedFlock one{"", {{0, 0, 0}}, {{1, 0, 0}}};
  EXPECT_THROW(Engine(world, {Driven(one, {Force("gravitas")})}, {}), InputError);
  EXPECT_THROW(Engine(world, {Driven(one, {Force("gravity", {{"h", 1}})})}, {}), InputError);
  Swarm lin = AsSwarm(one, LinParameters<double>{});
  lin.forces = {Force("gravity")};
  EXPECT_THROW(Engine(world, {lin}, {}), InputError);
}

}  // namespace
}  // namespace flocklift
