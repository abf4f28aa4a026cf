// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "simulate/core/check.h"
#include "tests/reconstruct/fit/flocks.h"
#include "tests/reconstruct/fit/linear_flock.h"

namespace flocklift {
namespace {

// Everything that is not a weight, as the scene has it; the weights start elsewhere.
FitProblem ProblemOf(const Scene& scene) {
  FitProblem problem;
  problem.model = scene.species[0].model;
  for (const char* weight : {"alpha_s", "alpha_c", "alpha_a", "alpha_b", "cruise", "level"}) {
    problem.model.parameters[weight] = 0.3;
  }
  problem.walls = scene.box;
  return problem;
}

FitResult Fit(const FitProblem& problem, const Trajectories& flock, FitOptions options = {},
              int threads = 2) {
  return FitModel(options, problem, flock, flock.fps.value_or(30), 1, threads);
}

const FittedWeight& WeightOf(const FitResult& result, const std::string& name) {
  const auto found = std::find_if(result.weights.begin(), result.weights.end(),
                                  [&](const FittedWeight& w) { return w.name == name; });
  if (found == result.weights.end()) throw std::logic_error("no weight " + name);
  return *found;
}

bool Warns(const FitResult& result, const std::string& text) {
  return std::any_of(result.warnings.begin(), result.warnings.end(),
                     [&](const std::string& w) { return w.find(text) != std::string::npos; });
}

TEST(Fit, RecoversTheWeightsOfTheSimulatorAndItsNoise) {
  Scene scene = BoidsScene(3);
  scene.duration = 20;
  const FitResult result = Fit(ProblemOf(scene), Fly(scene));
  ASSERT_TRUE(result.IsUsable());
  ASSERT_EQ(result.weights.size(), 6U);
  for (const FittedWeight& weight : result.weights) {
    const double truth = scene.species[0].model.parameters.at(weight.name);
    EXPECT_LT(std::abs(weight.estimate - truth), 3 * weight.sd) << weight.name;
    EXPECT_TRUE(weight.determined) << weight.name;
    EXPECT_EQ(result.parameters.model.parameters.at(weight.name), weight.value);
  }
  EXPECT_NEAR(WeightOf(result, "alpha_s").estimate, 2.0, 0.06);
  EXPECT_NEAR(WeightOf(result, "alpha_a").estimate, 0.8, 0.12);
  EXPECT_NEAR(result.noise_sd, 2.0, 0.4);
  EXPECT_NEAR(result.noise_time, 0.6, 0.15);
  EXPECT_NEAR(result.own_speed_mean, 10, 0.5);
  EXPECT_GT(result.r2_held_out.value(), 0.3);
  EXPECT_GT(result.worst.sd, result.best.sd);
  // What differences of the same frames would have said.
  EXPECT_LT(WeightOf(result, "alpha_a").plain, 0.6);
  EXPECT_LT(WeightOf(result, "level").plain, 0.3);
}

TEST(Fit, IntervalsCoverOverSeedsWhereLeastSquaresIsFarOff) {
  constexpr int kSeeds = 16;
  std::map<std::string, int> covered;
  std::map<std::string, double> squares;
  double plain = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Scene scene = BoidsScene(static_cast<std::uint64_t>(seed));
    scene.species[0].count = 12;
    FitOptions options;
    options.held_out = 0;
    const FitResult result = Fit(ProblemOf(scene), Fly(scene), options);
    ASSERT_TRUE(result.IsUsable());
    for (const FittedWeight& weight : result.weights) {
      const double truth = scene.species[0].model.parameters.at(weight.name);
      const double z = (weight.estimate - truth) / weight.sd;
      covered[weight.name] += std::abs(z) < 1.96 ? 1 : 0;
      squares[weight.name] += z * z / kSeeds;
    }
    plain += WeightOf(result, "alpha_a").plain / kSeeds;
  }
  int all = 0;
  for (const auto& [name, count] : covered) {
    EXPECT_GE(count, 12) << name;  // of 16
    all += count;
    EXPECT_GT(squares[name], 0.2) << name << ": intervals much too wide";
  }
  EXPECT_GE(all, 82);     // of 96: 85 %
  EXPECT_LT(plain, 0.5);  // true 0.8
}

TEST(Fit, PositionNoiseWidensTheWindowAndTheIntervals) {
  Scene scene = BoidsScene(5);
  scene.duration = 20;
  const Trajectories clean = Fly(scene);
  const FitResult sharp = Fit(ProblemOf(scene), clean);
  const FitResult noisy = Fit(ProblemOf(scene), WithNoise(clean, 0.01, 9));
  EXPECT_EQ(sharp.window, 1);
  EXPECT_GT(noisy.window, 1);
  for (const FittedWeight& weight : noisy.weights) {
    const double truth = scene.species[0].model.parameters.at(weight.name);
    EXPECT_LT(std::abs(weight.estimate - truth), 3 * weight.sd) << weight.name;
    EXPECT_GT(weight.sd, WeightOf(sharp, weight.name).sd) << weight.name;
  }
}

// The reference flock of equations.md 2b: N = 20, dt 0.005, 3000 frames, positions only.
Scene LinearScene(std::uint64_t seed) {
  Scene scene;
  scene.seed = seed;
  scene.fps = 200;
  scene.duration = 15;
  scene.warmup = 1;
  SpeciesSpec species;
  species.count = 20;
  species.speed = 0.3;
  species.start = Region{{-1, -1, -1}, {1, 1, 1}};
  species.model = {.name = "linear",
                   .parameters = {{"cohesion", 0.05}, {"alignment", 0.2}, {"diffusion", 5e-3}},
                   .where = {},
                   .where_of = {}};
  scene.species = {species};
  return scene;
}

TEST(Fit, LinearFlockFromNoisyPositionsWhereDifferencesAreNinetyPercentOff) {
  const Scene scene = LinearScene(2);
  FitProblem problem;
  problem.model.name = "linear";
  const Trajectories flock = Fly(scene);
  for (const double noise : {0.0, 3e-4}) {
    const FitResult result = Fit(problem, WithNoise(flock, noise, 4));
    ASSERT_TRUE(result.IsUsable());
    EXPECT_NEAR(WeightOf(result, "cohesion").estimate, 0.05, 0.006) << noise;
    EXPECT_NEAR(WeightOf(result, "alignment").estimate, 0.2, 0.024) << noise;
    EXPECT_NEAR(result.diffusion, 5e-3, 5e-4) << noise;
    EXPECT_LT(WeightOf(result, "cohesion").plain, 0.02) << noise;
  }
}

TEST(Fit, PlainDifferencesAreTakenOnlyWhenNamedAndThenNotSilently) {
  const Scene scene = BoidsScene(1);
  const Trajectories flock = Fly(scene);
  FitProblem problem = ProblemOf(scene);
  const FitResult chosen = Fit(problem, flock);
  EXPECT_EQ(chosen.method, FitMethod::kErrorsInVariables);  // its speed limits are not smooth
  EXPECT_FALSE(Warns(chosen, "biased"));
  problem.method = FitMethod::kDifferences;
  const FitResult named = Fit(problem, flock);
  EXPECT_EQ(named.method, FitMethod::kDifferences);
  EXPECT_TRUE(Warns(named, "biased"));
  EXPECT_EQ(WeightOf(named, "alpha_a").estimate, WeightOf(named, "alpha_a").plain);
}

TEST(Fit, EveryEstimatorByItsNameOnTheLinearFlock) {
  const LinearFlock flock = FlyLinearFlock(3, 2000);
  FitProblem problem;
  problem.model.name = "linear";
  std::map<FitMethod, FitResult> results;
  for (const FitMethod method : {FitMethod::kAuto, FitMethod::kStateSpace,
                                 FitMethod::kErrorsInVariables, FitMethod::kDifferences}) {
    EXPECT_EQ(FitMethodOf(NameOf(method)), method);
    problem.method = method;
    results[method] = Fit(problem, WithNoise(flock.seen, 1e-4, 5));
    ASSERT_TRUE(results[method].IsUsable());
  }
  const FitResult& states = results[FitMethod::kAuto];
  EXPECT_EQ(states.method, FitMethod::kStateSpace);
  EXPECT_EQ(states.weights[0].estimate, results[FitMethod::kStateSpace].weights[0].estimate);
  EXPECT_NEAR(states.position_noise.value(), 1e-4, 2e-5);
  EXPECT_NEAR(states.diffusion, LinearFlock::kDiffusion, 3 * states.diffusion_sd.value());
  for (const auto& [name, truth] : {std::pair("cohesion", LinearFlock::kCohesion),
                                    std::pair("alignment", LinearFlock::kAlignment)}) {
    const FittedWeight& best = WeightOf(states, name);
    EXPECT_LT(std::abs(best.estimate - truth), 3 * best.sd) << name;
    const FittedWeight& regressed = WeightOf(results[FitMethod::kErrorsInVariables], name);
    EXPECT_LT(std::abs(regressed.estimate - truth), 3 * regressed.sd) << name;
    EXPECT_LT(best.sd, regressed.sd) << name;
    EXPECT_LT(std::abs(WeightOf(results[FitMethod::kDifferences], name).estimate), 0.1 * truth)
        << name;
  }
  EXPECT_THROW(FitMethodOf("guess"), std::invalid_argument);
}

// Boids whose edges are soft, which know no cruising speeds and whose noise forgets at once.
Scene SmoothScene(std::uint64_t seed) {
  Scene scene = BoidsScene(seed);
  scene.duration = 2.5;
  scene.box = {{-10, -10, 0}, {10, 10, 20}};
  scene.species[0].model.parameters.insert_or_assign("taper", 1.0);
  for (const auto& [name, value] : std::map<std::string, double>{{"d_v", 6.0},
                                                                 {"s_min", 3.0},
                                                                 {"wall_taper", 3.0},
                                                                 {"cruise", 0.0},
                                                                 {"level", 0.0},
                                                                 {"noise", 1.0},
                                                                 {"noise_time", 0.0}}) {
    scene.species[0].model.parameters[name] = value;
  }
  return scene;
}

TEST(Fit, RadiiThroughTheirTapersTogetherWithTheWeights) {
  const Scene scene = SmoothScene(2);
  const auto& truth = scene.species[0].model.parameters;
  FitProblem problem;
  problem.model = scene.species[0].model;
  problem.walls = scene.box;
  problem.free = {"d_s", "alpha_s", "alpha_c", "d_v", "alpha_a", "alpha_b"};
  problem.model.parameters["d_s"] = 2.3;
  problem.model.parameters["d_v"] = 5.2;
  const FitResult result = Fit(problem, Fly(scene));
  ASSERT_TRUE(result.IsUsable());
  EXPECT_EQ(result.method, FitMethod::kStateSpace);
  EXPECT_TRUE(result.converged);
  ASSERT_EQ(result.weights.size(), 6U);
  for (const FittedWeight& weight : result.weights) {
    EXPECT_LT(std::abs(weight.estimate - truth.at(weight.name)), 3 * weight.sd) << weight.name;
    EXPECT_TRUE(weight.determined) << weight.name;
    EXPECT_EQ(result.parameters.model.parameters.at(weight.name), weight.value);
  }
  EXPECT_LT(WeightOf(result, "d_s").sd, 0.02);
  EXPECT_LT(WeightOf(result, "d_v").sd, 0.5);
  EXPECT_TRUE(std::isnan(WeightOf(result, "d_v").plain));
  EXPECT_EQ(result.parameters.posterior.correlation.size(), 36U);
  EXPECT_GT(result.worst.sd, result.best.sd);
  EXPECT_NEAR(result.noise_sd, 1, 0.1);
  // What is left of accelerations over a frame's width, S = 4 steps a frame, is the noise under
  // their triangle: sd 1 times sqrt((2 S^2 + 1) / (3 S^3)).
  ASSERT_EQ(result.window, 1);
  EXPECT_NEAR(result.residual_sd, 0.415, 0.06);
}

// What is known for its sign alone is no longer called determined where more is asked for.
TEST(Fit, FlagsWhatIsNotKnownToTheShareThatIsAskedFor) {
  const Trajectories seen = FlyLinearFlock(4, 1500).seen;
  FitProblem problem;
  problem.model.name = "linear";
  problem.free = {"cohesion", "alignment"};
  const FitResult plain = Fit(problem, seen);
  const double share = 3 * WeightOf(plain, "alignment").sd / WeightOf(plain, "alignment").estimate;
  ASSERT_TRUE(WeightOf(plain, "alignment").determined);
  for (const double factor : {0.99, 1.01}) {
    FitOptions options;
    options.known_within = factor * share;
    const FitResult asked = Fit(problem, seen, options);
    EXPECT_EQ(asked.weights[1].estimate, plain.weights[1].estimate);
    EXPECT_EQ(asked.weights[1].determined, factor > 1);
    EXPECT_EQ(asked.parameters.posterior.determined[1], factor > 1);
    EXPECT_EQ(Warns(asked, "alignment"), factor < 1);
  }
}

// With what is held at the truth no word of it; with what is held elsewhere, its name.
TEST(Fit, WhatIsHeldAgainstTheMotionIsNamed) {
  const Trajectories seen = FlyLinearFlock(4, 1500).seen;
  FitProblem problem;
  problem.model.name = "linear";
  problem.free = {"alignment"};
  for (const FitMethod method : {FitMethod::kStateSpace, FitMethod::kErrorsInVariables}) {
    problem.method = method;
    problem.model.parameters = {{"cohesion", LinearFlock::kCohesion}};
    const FitResult right = Fit(problem, seen);
    ASSERT_EQ(right.held.size(), 1U);
    EXPECT_EQ(right.held[0].name, "cohesion");
    EXPECT_LT(std::abs(right.held[0].z), 3.5);
    EXPECT_FALSE(Warns(right, "is held at"));
    problem.model.parameters = {{"cohesion", 0}};
    const FitResult wrong = Fit(problem, seen);
    EXPECT_GT(wrong.held.at(0).z, 5);
    EXPECT_TRUE(Warns(wrong, "cohesion is held at 0, and the motion speaks against that"));
    EXPECT_TRUE(Warns(wrong, "--free alignment,cohesion"));
  }
  problem.free = {"alignment", "cohesion"};
  EXPECT_TRUE(Fit(problem, seen).held.empty());
}

TEST(Fit, ARadiusThatNobodyCrossesIsNotDetermined) {
  Scene scene = SmoothScene(3);
  scene.duration = 1.5;
  FitProblem problem;
  problem.model = scene.species[0].model;
  problem.walls = scene.box;
  problem.free = {"alpha_a", "alpha_s", "d_v"};
  problem.model.parameters["d_v"] = 200;  // all are neighbours, as far as anybody can tell
  const FitResult result = Fit(problem, Fly(scene));
  ASSERT_TRUE(result.IsUsable());
  EXPECT_FALSE(WeightOf(result, "d_v").determined);
  EXPECT_TRUE(std::isinf(WeightOf(result, "d_v").sd));
  EXPECT_TRUE(Warns(result, "do not determine d_v"));
  problem.free = {"d_v"};
  EXPECT_THROW(Fit(problem, Fly(scene)), InputError);  // nothing to start from
}

TEST(Fit, AStateSpaceEstimateIsRefusedWhereTheModelIsNotSmooth) {
  const Scene scene = BoidsScene(1);
  FitProblem problem = ProblemOf(scene);
  problem.method = FitMethod::kStateSpace;
  EXPECT_THROW(Fit(problem, Fly(scene)), InputError);
}

TEST(Fit, FreesOnlyWhatIsAskedForAndTakesTheRestAsGiven) {
  const Scene scene = BoidsScene(2);
  FitProblem problem;
  problem.model = scene.species[0].model;
  problem.walls = scene.box;
  problem.free = {"alpha_a", "alpha_s"};
  const FitResult result = Fit(problem, Fly(scene));
  ASSERT_EQ(result.weights.size(), 2U);
  EXPECT_EQ(result.parameters.posterior.free, problem.free);
  EXPECT_EQ(result.parameters.model.parameters.at("level"), 0.5);
  for (const FittedWeight& weight : result.weights) {
    const double truth = scene.species[0].model.parameters.at(weight.name);
    EXPECT_LT(std::abs(weight.estimate - truth), 3 * weight.sd) << weight.name;
  }
}

TEST(Fit, GapsAndComingAndGoingCostRowsNotBias) {
  Scene scene = BoidsScene(4);
  scene.duration = 20;
  Trajectories flock = Fly(scene);
  const FitResult whole = Fit(ProblemOf(scene), flock);
  Rng rng(8);
  for (Trajectory& trajectory : flock.trajectories) {
    std::erase_if(trajectory.points, [&](const TrajectoryPoint& point) {
      const bool away = trajectory.id % 5 == 0 && point.frame > 300 && point.frame < 360;
      return away || rng.Uniform() < 0.02;
    });
  }
  const FitResult result = Fit(ProblemOf(scene), flock);
  ASSERT_TRUE(result.IsUsable());
  EXPECT_LT(result.rows, whole.rows);
  EXPECT_GT(result.rows, whole.rows / 2);
  for (const FittedWeight& weight : result.weights) {
    const double truth = scene.species[0].model.parameters.at(weight.name);
    EXPECT_LT(std::abs(weight.estimate - truth), 3 * weight.sd) << weight.name;
  }
}

TEST(Fit, IsTheSameAtAnyNumberOfThreads) {
  const Scene scene = BoidsScene(6);
  Trajectories flock = Fly(scene);
  flock.has_sd_depth = true;
  for (Trajectory& t : flock.trajectories) {
    for (TrajectoryPoint& p : t.points) p.sd_depth = 0.3;
  }
  FitOptions options;
  options.depth_draws = 2;
  const FitResult one = Fit(ProblemOf(scene), flock, options, 1);
  const FitResult three = Fit(ProblemOf(scene), flock, options, 3);
  for (std::size_t k = 0; k < one.weights.size(); ++k) {
    EXPECT_EQ(one.weights[k].estimate, three.weights[k].estimate);
    EXPECT_EQ(one.weights[k].sd, three.weights[k].sd);
    EXPECT_EQ(one.weights[k].depth_factor, three.weights[k].depth_factor);
  }
}

TEST(Fit, DepthErrorsAreToldInFigures) {
  // Seen from 60 m away along y, depths wrong by a slow error of 1 m.
  Scene scene = BoidsScene(7);
  const Trajectories truth = Fly(scene);
  Trajectories seen = truth;
  seen.has_sd_depth = true;
  FitProblem problem = ProblemOf(scene);
  Camera camera = PinholeCamera(50, 1920, 1080);
  camera.cam_from_world = LookAt({0, -60, 2}, {0, 0, 12});
  problem.camera = camera;
  for (Trajectory& trajectory : seen.trajectories) {
    const double phase = static_cast<double>(trajectory.id);
    for (TrajectoryPoint& point : trajectory.points) {
      point.position.y += 1.4 * std::sin(0.05 * point.frame + 2.4 * phase);
      point.sd_depth = 1;
    }
  }
  FitOptions options;
  options.depth_draws = 2;
  const FitResult clean = Fit(problem, truth, options);
  const FitResult result = Fit(problem, seen, options);
  ASSERT_TRUE(result.IsUsable());
  EXPECT_FALSE(clean.weights[0].depth_factor.has_value());
  EXPECT_FALSE(Warns(clean, "depth errors"));
  EXPECT_TRUE(Warns(result, "depth errors (median sd 1 m)"));
  // Separation loses its neighbours: the estimate is low, and the factor says so.
  const FittedWeight& separation = WeightOf(result, "alpha_s");
  EXPECT_LT(separation.estimate, 1.7);
  ASSERT_TRUE(separation.depth_factor.has_value());
  EXPECT_LT(*separation.depth_factor, 0.9);
  EXPECT_GT(*separation.depth_factor, 0.0);
}

TEST(Fit, AStateSpaceEstimateTakesStatedDepthErrorsAlong) {
  Scene scene = BoidsScene(7);
  scene.duration = 2;
  scene.species[0].count = 6;
  for (const auto& [name, value] : std::map<std::string, double>{
           {"taper", 1}, {"cruise", 0}, {"level", 0}, {"noise_time", 0}, {"s_min", 3}}) {
    scene.species[0].model.parameters[name] = value;
  }
  const Trajectories truth = Fly(scene);
  Trajectories seen = truth;
  seen.has_sd_depth = true;
  for (Trajectory& trajectory : seen.trajectories) {
    const double phase = static_cast<double>(trajectory.id);
    for (TrajectoryPoint& point : trajectory.points) {
      point.position += Vec3d{0, 60 + 0.3 * std::sin(0.03 * point.frame + 2.4 * phase), 0};
      point.sd_depth = 0.2;
    }
  }
  FitProblem problem;
  problem.model = scene.species[0].model;
  problem.free = {"alpha_c", "alpha_a"};
  EXPECT_EQ(Fit(problem, seen).method, FitMethod::kErrorsInVariables);
  problem.method = FitMethod::kStateSpace;
  const FitResult result = Fit(problem, seen);
  ASSERT_TRUE(result.IsUsable());
  EXPECT_EQ(result.method, FitMethod::kStateSpace);
  EXPECT_TRUE(result.converged);
  EXPECT_TRUE(Warns(result, "are estimated with the weights"));
  const FitResult without = Fit(problem, truth);
  for (std::size_t k = 0; k < result.weights.size(); ++k) {
    const FittedWeight& weight = result.weights[k];
    EXPECT_FALSE(weight.depth_factor.has_value());
    EXPECT_TRUE(weight.depth_share.has_value());
    EXPECT_GT(weight.sd, without.weights[k].sd);
    EXPECT_NEAR(weight.estimate, without.weights[k].estimate, 3 * weight.sd) << weight.name;
  }
  FitOptions brief;  // errors of a thousandth of a second would be as many as the positions
  brief.depth_error_time = 1e-3;
  for (Trajectory& trajectory : seen.trajectories) {
    for (TrajectoryPoint& point : trajectory.points) point.sd_depth = 0.01;
  }
  const FitResult fallen = Fit(problem, seen, brief);
  EXPECT_EQ(fallen.method, FitMethod::kErrorsInVariables);
  EXPECT_TRUE(Warns(fallen, "unknown depth errors: by regression"));
}

TEST(Fit, AForeignMotionIsSaidToBeUnexplained) {
  // Random walks of the velocity that know nothing of each other.
  Trajectories flock;
  flock.fps = 30;
  for (Id id = 1; id <= 15; ++id) {
    Rng rng(12, static_cast<std::uint64_t>(id));
    Vec3d x{20 * rng.Normal(), 20 * rng.Normal(), 20 * rng.Normal()};
    Vec3d v{10, 0, 0};
    Trajectory trajectory{.id = id, .points = {}};
    for (int frame = 1; frame <= 300; ++frame) {
      v += 0.3 * Vec3d{rng.Normal(), rng.Normal(), rng.Normal()};
      x += v / 30.0;
      TrajectoryPoint point;
      point.frame = frame;
      point.position = x;
      trajectory.points.push_back(point);
    }
    flock.trajectories.push_back(trajectory);
  }
  FitProblem problem;
  problem.model.name = "boids";
  problem.model.parameters = {{"s_min", 0}, {"s_max", 100}};
  problem.free = {"alpha_a", "alpha_c"};
  problem.model.parameters["cruise"] = 0;
  problem.model.parameters["level"] = 0;
  problem.model.parameters["alpha_s"] = 0;
  const FitResult result = Fit(problem, flock);
  ASSERT_TRUE(result.IsUsable());
  EXPECT_LT(result.r2_held_out.value(), 0.03);
  EXPECT_LT(std::abs(WeightOf(result, "alpha_a").estimate), 3 * WeightOf(result, "alpha_a").sd);
}

TEST(Fit, ATermThatNeverActsIsNotDetermined) {
  const Scene scene = BoidsScene(2);
  FitProblem problem = ProblemOf(scene);
  problem.model.parameters["d_s"] = 1e-6;
  const FitResult result = Fit(problem, Fly(scene));
  const FittedWeight& separation = WeightOf(result, "alpha_s");
  EXPECT_FALSE(separation.determined);
  EXPECT_TRUE(std::isinf(separation.sd));
  EXPECT_EQ(separation.value, 0.3);  // as it was given
  EXPECT_TRUE(Warns(result, "do not determine alpha_s"));
}

TEST(Fit, AMovingPointThatAttractsIsFoundWhenSomethingHoldsTheFlock) {
  Scene scene = BoidsScene(3);
  scene.duration = 12;
  scene.warmup = 10;
  scene.box = {{-1e6, -1e6, -1e6}, {1e6, 1e6, 1e6}};
  scene.species[0].start = Region{{-8, -8, 4}, {8, 8, 20}};
  GoalSpec goal;
  goal.position = {3, -2, 12};
  goal.radius = 3;
  goal.period = 9;
  scene.goals = {goal};
  FitProblem problem = ProblemOf(scene);
  problem.walls.reset();
  const Trajectories flock = Fly(scene);
  const FitResult result = Fit(problem, flock);
  ASSERT_EQ(result.parameters.goals.size(), 1U);
  EXPECT_LT(Norm(result.parameters.goals[0].position - goal.position), 1.5);
  EXPECT_EQ(result.weights.back().name, "goal");
  EXPECT_EQ(result.parameters.posterior.free.back(), "level");  // the model's weights alone
  EXPECT_LT(std::abs(result.weights.back().estimate - 1), 3 * result.weights.back().sd);
  // In a dense flock a common goal and cohesion over all differ little; their sum is clear.
  EXPECT_NEAR(result.weights.back().estimate + WeightOf(result, "alpha_c").estimate, 1.1, 0.4);
  EXPECT_GT(result.worst.sd, 5 * result.best.sd);
  for (const FittedWeight& weight : result.weights) {
    if (weight.name == "goal") continue;
    const double truth = scene.species[0].model.parameters.at(weight.name);
    EXPECT_LT(std::abs(weight.estimate - truth), 3 * weight.sd) << weight.name;
  }
  problem.goal = GoalChoice::kNone;
  const FitResult without = Fit(problem, flock);
  EXPECT_TRUE(without.parameters.goals.empty());
  EXPECT_TRUE(Warns(without, "holds the animals in place"));
  EXPECT_LT(without.r2, result.r2);
}

TEST(Fit, NoPointIsFoundWhereNothingAttracts) {
  const Scene scene = BoidsScene(5);
  const FitResult result = Fit(ProblemOf(scene), Fly(scene));
  EXPECT_TRUE(result.parameters.goals.empty());
  EXPECT_TRUE(result.parameters.walls.has_value());
}

TEST(Fit, WallsThatAreNotGivenAreMissed) {
  Scene scene = BoidsScene(9);
  scene.duration = 20;
  FitProblem problem = ProblemOf(scene);
  problem.walls.reset();
  problem.goal = GoalChoice::kNone;
  const FitResult result = Fit(problem, Fly(scene));
  EXPECT_EQ(result.weights.size(), 5U);  // without alpha_b
  EXPECT_TRUE(Warns(result, "give them"));
}

TEST(Fit, TooLittleDataIsAStatus) {
  FitProblem problem;
  problem.model.name = "boids";
  EXPECT_EQ(Fit(problem, Trajectories{}).status, FitStatus::kTooFewAnimals);
  Scene scene = BoidsScene(1);
  scene.duration = 0.1;  // 3 frames
  EXPECT_EQ(Fit(ProblemOf(scene), Fly(scene)).status, FitStatus::kTooFewRows);
  scene.duration = 1.0 / 30;
  EXPECT_EQ(Fit(ProblemOf(scene), Fly(scene)).status, FitStatus::kTooFewFrames);
  scene.duration = 0.5;
  EXPECT_FALSE(Fit(ProblemOf(scene), Fly(scene)).IsUsable());
  EXPECT_FALSE(StatusText(FitStatus::kTooFewFrames).empty());
}

TEST(Fit, RefusesWhatMakesNoSense) {
  const Scene scene = BoidsScene(1);
  const Trajectories flock = Fly(scene);
  FitProblem problem = ProblemOf(scene);
  problem.free = {"alpha_x"};
  EXPECT_THROW(Fit(problem, flock), InputError);
  problem.free = {"d_s"};
  EXPECT_THROW(Fit(problem, flock), InputError);
  problem.free = {"alpha_b"};
  problem.walls.reset();
  EXPECT_THROW(Fit(problem, flock), InputError);
  problem = {};
  problem.model.name = "starlings";
  EXPECT_THROW(Fit(problem, flock), InputError);
  problem.model.name = "shape";
  EXPECT_THROW(Fit(problem, flock), InputError);
  FitOptions options;
  options.held_out = 2;
  EXPECT_THROW(Fit(ProblemOf(scene), flock, options), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
