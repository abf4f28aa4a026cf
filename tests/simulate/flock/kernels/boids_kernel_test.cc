// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/kernels/boids_kernel.h"

#include <gtest/gtest.h>

#include "tests/simulate/flock/flocks.h"

namespace flocklift {
namespace {

std::vector<Vec3d> FloatAccelerations(const NamedFlock& flock, const BoidsParameters<double>& p,
                                      const std::string& kernel, double* neighbours) {
  World world;
  world.dt = 1e-6;
  Engine engine(world, {AsSwarm(flock, p)}, {.threads = 1, .kernel = kernel});
  engine.Step();
  *neighbours = engine.MeanNeighbours();
  return engine.Accelerations();
}

// The last on the lattice: neighbours exactly on the edge.
const std::vector<BoidsParameters<double>>& Rules() {
  static const std::vector<BoidsParameters<double>> rules = {
      PlainRules(0.4, 1.05), PlainRules(2.1, 0.7), PlainRules(0.4, 1.05, 0.3),
      PlainRules(1.0, 1.0)};
  return rules;
}

TEST(BoidsKernel, EveryVariantOfThisMachineGivesTheSameBytes) {
  int variants = 0;
  for (const BoidsKernelVariant& variant : kBoidsKernels) {
    if (!variant.supported()) continue;
    ++variants;
    for (const NamedFlock& flock : ManyFlocks()) {
      SCOPED_TRACE(variant.name + (" " + flock.name));
      for (const BoidsParameters<double>& p : Rules()) {
        double neighbours = 0, expected_neighbours = 0;
        const auto expected = FloatAccelerations(flock, p, "scalar", &expected_neighbours);
        const auto actual = FloatAccelerations(flock, p, variant.name, &neighbours);
        EXPECT_EQ(actual, expected);
        EXPECT_EQ(neighbours, expected_neighbours);
      }
    }
  }
  EXPECT_GE(variants, 1);
}

TEST(MoveKernel, EveryVariantOfThisMachineGivesTheSameBytes) {
  NamedFlock flock = RandomFlock("", 1037, {8, 8, 8}, 13);
  flock.velocity[5] = {};  // no direction to scale
  BoidsParameters<double> p = PlainRules(0.4, 1.05);
  p.s_min = 3;
  p.s_max = 6;
  const auto after = [&](const std::string& kernel) {
    World world;
    world.dt = 0.02;
    Engine engine(world, {AsSwarm(flock, p)}, {.threads = 1, .kernel = kernel});
    for (int step = 0; step < 5; ++step) engine.Step();
    return engine.State();
  };
  const FlockState expected = after("scalar");
  for (const BoidsKernelVariant& variant : kBoidsKernels) {
    if (!variant.supported()) continue;
    SCOPED_TRACE(variant.name);
    const FlockState actual = after(variant.name);
    EXPECT_EQ(actual.position, expected.position);
    EXPECT_EQ(actual.velocity, expected.velocity);
  }
}

TEST(BoidsKernel, AgreesWithDouble) {
  const NamedFlock flock = RandomFlock("", 1500, {6, 6, 6}, 12);
  for (const BoidsParameters<double>& p : {PlainRules(0.4, 1.05), PlainRules(0.4, 1.05, 0.3)}) {
    World world;
    world.dt = 1e-6;
    ReferenceEngine engine(world, {AsSwarm(flock, p)}, {});
    engine.Step();
    double neighbours = 0;
    const auto actual = FloatAccelerations(flock, p, "", &neighbours);
    const auto expected = engine.Accelerations();
    for (std::size_t k = 0; k < expected.size(); ++k) {
      EXPECT_LT(Norm(actual[k] - expected[k]), 1e-5 * (1 + Norm(expected[k]))) << k;
    }
    EXPECT_NEAR(neighbours, engine.MeanNeighbours(), 1e-4 * neighbours);
  }
}

TEST(BoidsKernel, UnknownVariantIsRefused) {
  double neighbours = 0;
  EXPECT_THROW(
      FloatAccelerations(RandomFlock("", 3, {1, 1, 1}, 1), PlainRules(1, 1), "mmx", &neighbours),
      std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
