// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What every motion must pass, and what is measured of flocks.

#ifndef FLOCKLIFT_TESTS_SIMULATE_FLOCK_MOTION_CHECKS_H_
#define FLOCKLIFT_TESTS_SIMULATE_FLOCK_MOTION_CHECKS_H_

#include <gtest/gtest.h>

#include <string>

#include "tests/simulate/flock/flocks.h"

namespace flocklift {

// Length of the mean heading: 1 for one direction, about 1/sqrt(N) for none.
inline double Polarization(const FlockState& state) {
  Vec3d sum;
  for (const Vec3d& v : state.velocity) sum += Normalized(v);
  return Norm(sum) / static_cast<double>(state.size());
}

// A flock among walls, a predator and a goal.
inline FlockState FlyOf(const ModelParameters& model, int threads, const std::string& kernel,
                        int steps = 12) {
  World world;
  world.seed = 5;
  world.dt = 0.02;
  world.box = {{-5, -5, -5}, {15, 15, 15}};
  world.goals = {{.species = "bird", .position = {5, 5, 5}, .radius = 3, .period = 4, .weight = 1}};
  world.predators = {{.count = 1, .speed = 8, .fear_radius = 4, .fear_weight = 9}};
  Engine engine(world, {AsSwarm(RandomFlock("", 2500, {14, 14, 14}, 42), model)},
                {.threads = threads, .kernel = kernel});
  for (int step = 0; step < steps; ++step) engine.Step();
  return engine.State();
}

inline void ExpectSameBytesEverywhere(const ModelParameters& model) {
  const FlockState expected = FlyOf(model, 1, "");
  for (const auto& [threads, kernel] :
       {std::pair{2, ""}, std::pair{1, "scalar"}, std::pair{3, "sse2"}}) {
    const FlockState actual = FlyOf(model, threads, kernel);
    EXPECT_EQ(actual.position, expected.position) << threads << kernel;
    EXPECT_EQ(actual.velocity, expected.velocity) << threads << kernel;
  }
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_SIMULATE_FLOCK_MOTION_CHECKS_H_
