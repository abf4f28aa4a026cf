// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/state_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "reconstruct/fit/fit.h"
#include "tests/reconstruct/fit/flocks.h"
#include "tests/reconstruct/fit/linear_flock.h"

namespace flocklift {
namespace {

ProcessModel Linear() {
  ModelSpec model;
  model.name = "linear";
  return MakeProcessModel(model, {"cohesion", "alignment"});
}

FilterInput InputOf(const Trajectories& seen) {
  return FilterInput(ObservedFlock(seen, seen.fps.value(), 5));
}

StateSpaceFit Fit(const Trajectories& seen, int threads = 2) {
  return FitStateSpace({.filter = {}, .threads = threads}, Linear(), {0, 0}, InputOf(seen));
}

TEST(StateSpace, PositionsAloneAreAsGoodAsTrueVelocities) {
  // Over some seeds, the distance from the estimate of true velocities is small beside its error.
  double apart = 0, error = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const LinearFlock flock = FlyLinearFlock(seed);
    const StateSpaceFit fit = Fit(flock.seen);
    ASSERT_EQ(fit.status, StateSpaceStatus::kOk);
    for (std::size_t p = 0; p < 2; ++p) {
      apart += std::pow((fit.estimate[p] - flock.from_true_velocities[p]) / fit.sd[p], 2);
      error +=
          std::pow((fit.estimate[p] - (p == 0 ? LinearFlock::kCohesion : LinearFlock::kAlignment)) /
                       fit.sd[p],
                   2);
    }
    EXPECT_NEAR(fit.noise.diffusion, LinearFlock::kDiffusion, 4 * fit.diffusion_sd);
    EXPECT_LT(std::sqrt(fit.noise.position_variance), 2e-6);
  }
  EXPECT_LT(apart, 0.32 * error);  // (1.15^2 - 1), were the two independent
  EXPECT_LT(error, 30);            // of 8, each about 1
}

void ExpectNoiseFound(std::uint64_t seed, double sd) {
  const StateSpaceFit fit = Fit(WithNoise(FlyLinearFlock(seed).seen, sd, 1000 + seed));
  ASSERT_EQ(fit.status, StateSpaceStatus::kOk);
  EXPECT_NEAR(fit.noise.position_variance, sd * sd, 4 * fit.position_variance_sd);
  EXPECT_LT(fit.position_variance_sd, 0.1 * sd * sd);
  EXPECT_NEAR(fit.noise.diffusion, LinearFlock::kDiffusion, 4 * fit.diffusion_sd);
  EXPECT_NEAR(fit.estimate[0], LinearFlock::kCohesion, 3.5 * fit.sd[0]);
  EXPECT_NEAR(fit.estimate[1], LinearFlock::kAlignment, 3.5 * fit.sd[1]);
}

TEST(StateSpace, FindsNoiseAndDiffusionItself) {
  ExpectNoiseFound(7, 1e-4);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) ExpectNoiseFound(seed, 1e-3);
}

TEST(StateSpace, IntervalsCoverOverShortRuns) {
  int covered = 0, intervals = 0;
  double squares = 0;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    const LinearFlock flock = FlyLinearFlock(seed, 600, 8);
    const StateSpaceFit fit = Fit(WithNoise(flock.seen, 1e-4, seed));
    ASSERT_TRUE(fit.IsUsable());
    for (std::size_t p = 0; p < 2; ++p) {
      const double truth = p == 0 ? LinearFlock::kCohesion : LinearFlock::kAlignment;
      const double z = (fit.estimate[p] - truth) / fit.sd[p];
      covered += std::abs(z) < 1.96 ? 1 : 0;
      squares += z * z;
      ++intervals;
    }
  }
  EXPECT_GE(covered, 42);  // of 50
  EXPECT_GT(squares / intervals, 0.4);
}

// What is held at its true value is contradicted by about one sd, over seeds, and what is held
// beside it by as much as a fit in which it is free says.
TEST(StateSpace, TheScoreOfAHeldParameterIsItsDistanceInSd) {
  ModelSpec model;
  model.name = "linear";
  const auto score = [&](const Trajectories& seen, double held) {
    model.parameters["cohesion"] = held;
    const FilterInput input = InputOf(seen);
    const StateSpaceFit fit = FitStateSpace({}, MakeProcessModel(model, {"alignment"}), {0}, input);
    const double values[] = {held};
    return ScoreHeld({}, MakeProcessModel(model, {"alignment", "cohesion"}), fit, values, input)
        .at(0);
  };
  double squares = 0;
  constexpr int kSeeds = 12;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    squares += std::pow(
        score(WithNoise(FlyLinearFlock(seed, 300, 8).seen, 1e-4, seed), LinearFlock::kCohesion).z,
        2);
  }
  EXPECT_GT(squares, 0.25 * kSeeds);
  EXPECT_LT(squares, 2.5 * kSeeds);
  const Trajectories seen = FlyLinearFlock(3, 800).seen;
  const StateSpaceFit both = Fit(seen);
  const HeldScore beside = score(seen, both.estimate[0] + 2 * both.sd[0]);
  EXPECT_NEAR(beside.z, -2, 0.4);
  EXPECT_NEAR(beside.change, -2 * both.sd[0], 0.4 * both.sd[0]);
  EXPECT_LT(score(seen, 0).change, 2 * LinearFlock::kCohesion);
  EXPECT_GT(score(seen, 0).z, 8);
  EXPECT_THROW(ScoreHeld({}, Linear(), both, std::vector<double>{1.0}, InputOf(seen)),
               std::invalid_argument);
}

TEST(StateSpace, GapsAndLateComersCostAccuracyNotTruth) {
  const LinearFlock flock = FlyLinearFlock(5);
  Trajectories holed = WithNoise(flock.seen, 1e-4, 3);
  const StateSpaceFit whole = Fit(holed);
  Rng rng(8);
  for (Trajectory& trajectory : holed.trajectories) {
    std::erase_if(trajectory.points, [&](const TrajectoryPoint&) { return rng.Uniform() < 0.05; });
  }
  const StateSpaceFit fit = Fit(holed);
  ASSERT_EQ(fit.status, StateSpaceStatus::kOk);
  EXPECT_LT(fit.innovations, whole.innovations);
  for (std::size_t p = 0; p < 2; ++p) {
    EXPECT_LT(std::abs(fit.estimate[p] - whole.estimate[p]), 0.5 * whole.sd[p]);
  }
}

TEST(StateSpace, IsTheSameAtAnyNumberOfThreads) {
  const LinearFlock flock = FlyLinearFlock(2, 300);
  const StateSpaceFit one = Fit(flock.seen, 1), three = Fit(flock.seen, 3);
  EXPECT_EQ(one.estimate, three.estimate);
  EXPECT_EQ(one.sd, three.sd);
  EXPECT_EQ(one.noise.diffusion, three.noise.diffusion);
}

// Boids that nothing disturbs, some of them at their speed limits: what is left is rounding, and
// all is known but for that.
TEST(StateSpace, FlocksWithoutNoiseAreKnownButForRounding) {
  for (const std::uint64_t seed : {3, 5}) {
    Scene scene = BoidsScene(seed);
    scene.duration = 3;
    ModelSpec& boids = scene.species[0].model;
    for (const char* absent : {"noise", "noise_time", "cruise", "level"}) {
      boids.parameters[absent] = 0;
    }
    boids.parameters["taper"] = 2;
    FitProblem problem;
    problem.model = boids;
    problem.model.parameters["d_s"] *= 1.2;
    problem.model.parameters["d_v"] *= 0.85;
    problem.free = {"alpha_s", "alpha_c", "alpha_a", "alpha_b", "d_s", "d_v"};
    problem.walls = scene.box;
    FitOptions options;
    options.substeps = scene.substeps;
    const FitResult fit = FitModel(options, problem, Fly(scene), scene.fps, 1, 2);
    ASSERT_TRUE(fit.IsUsable());
    EXPECT_TRUE(fit.converged);
    EXPECT_LT(fit.noise_sd, 1e-3);
    for (const HeldTest& held : fit.held) EXPECT_LT(std::abs(held.z), 3.5) << held.name;
    for (const FittedWeight& weight : fit.weights) {
      const double truth = boids.parameters.at(weight.name);
      EXPECT_TRUE(weight.determined) << weight.name;
      EXPECT_LT(weight.sd, 1e-4 * truth) << weight.name;
      EXPECT_LT(std::abs(weight.estimate - truth), 3 * weight.sd) << weight.name;
    }
  }
}

TEST(StateSpace, TooLittleDataIsAStatusAndNonsenseThrows) {
  EXPECT_EQ(Fit(FlyLinearFlock(1, 3, 2).seen).status, StateSpaceStatus::kTooFew);
  EXPECT_EQ(Fit(FlyLinearFlock(1, 1, 2).seen).status, StateSpaceStatus::kTooFew);
  EXPECT_THROW(FitStateSpace({}, Linear(), {0}, InputOf(FlyLinearFlock(1, 10).seen)),
               std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
