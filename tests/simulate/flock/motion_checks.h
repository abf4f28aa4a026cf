// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What every motion must pass, and what is measured of flocks.

#ifndef FLOCKLIFT_TESTS_SIMULATE_FLOCK_MOTION_CHECKS_H_
#define FLOCKLIFT_TESTS_SIMULATE_FLOCK_MOTION_CHECKS_H_

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "tests/simulate/flock/flocks.h"

namespace flocklift {

// Length of the mean heading: 1 for one direction, about 1/sqrt(N) for none.
inline double Polarization(const FlockState& state) {
  Vec3d sum;
  for (const Vec3d& v : state.velocity) sum += Normalized(v);
  return Norm(sum) / static_cast<double>(state.size());
}

// A flock among walls, a predator and a goal.
inline Engine BusyFlock(const ModelParameters& model, int threads = 1,
                        const std::string& kernel = "") {
  World world;
  world.seed = 5;
  world.dt = 0.02;
  world.box = {{-5, -5, -5}, {15, 15, 15}};
  world.goals = {{.species = "bird", .position = {5, 5, 5}, .radius = 3, .period = 4, .weight = 1}};
  world.predators = {{.count = 1, .speed = 8, .fear_radius = 4, .fear_weight = 9}};
  return Engine(world, {AsSwarm(RandomFlock("", 1100, {12, 12, 12}, 42), model)},
                {.threads = threads, .kernel = kernel});
}

inline FlockState After(Engine engine, int steps) {
  for (int step = 0; step < steps; ++step) engine.Step();
  return engine.State();
}

// At any number of threads, with any kernel, and after going on from a saved state.
inline void ExpectSameBytesEverywhere(const ModelParameters& model) {
  const FlockState expected = After(BusyFlock(model), 5);
  const auto expect_same = [&expected](const FlockState& actual) {
    EXPECT_EQ(actual.position, expected.position);
    EXPECT_EQ(actual.velocity, expected.velocity);
  };
  for (const auto& [threads, kernel] :
       {std::pair{2, ""}, std::pair{1, "scalar"}, std::pair{3, "sse2"}}) {
    SCOPED_TRACE(std::to_string(threads) + " threads " + kernel);
    expect_same(After(BusyFlock(model, threads, kernel), 5));
  }
  SCOPED_TRACE("saved");
  Engine first = BusyFlock(model), second = BusyFlock(model);
  for (int step = 0; step < 3; ++step) first.Step();
  second.Load(first.Save());
  expect_same(After(std::move(second), 2));
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_SIMULATE_FLOCK_MOTION_CHECKS_H_
