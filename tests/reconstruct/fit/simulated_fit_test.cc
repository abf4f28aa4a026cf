// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/simulated_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reconstruct/fit/fit.h"
#include "simulate/core/check.h"
#include "simulate/core/rng.h"
#include "tests/reconstruct/fit/flocks.h"

namespace flocklift {
namespace {

// Two animals abreast on circles of 2 m: everything is known.
TEST(MotionStatistics, OfTwoOnACircleAreThoseOfTheCircle) {
  const double dt = 0.01, rate = 1.5, radius = 2;
  std::vector<FramePositions> frames;
  for (int f = 0; f < 50; ++f) {
    const double angle = rate * dt * f;
    const Vec3d x{radius * std::cos(angle), radius * std::sin(angle), 0};
    frames.push_back({{3, 8}, {x, x + Vec3d{0, 0, 0.7}}});
  }
  const auto statistics = ComputeMotionStatistics(frames, dt);
  ASSERT_TRUE(statistics.has_value());
  const std::size_t n = kMotionQuantiles.size();
  for (std::size_t q = 0; q < n; ++q) {
    EXPECT_NEAR((*statistics)[q], radius * rate, 1e-3);
    EXPECT_NEAR((*statistics)[n + q], radius * rate * rate, 1e-3);
    EXPECT_NEAR((*statistics)[2 * n + q], rate, 1e-3);
    EXPECT_NEAR((*statistics)[3 * n + q], 0.7, 1e-12);
    EXPECT_NEAR((*statistics)[4 * n + q], 1, 1e-12);
    EXPECT_EQ((*statistics)[5 * n + q], 0);
  }
}

TEST(MotionStatistics, OfAPlaceToFlyToAreTheDistancesInTheFramesLookedAt) {
  const std::vector<FramePositions> frames(4, {{1, 2}, {{0, 0, 0}, {3, 0, 0}}});
  const auto target = [](std::size_t frame, const std::vector<Vec3d>& places) {
    std::vector<double> distances;
    for (const Vec3d& place : places) {
      if (frame % 2 == 0) distances.push_back(1 + Norm(place));
    }
    return distances;
  };
  // Nobody moves, so there is no direction.
  EXPECT_FALSE(ComputeMotionStatistics(frames, 1, target).has_value());
  std::vector<FramePositions> moving = frames;
  for (std::size_t f = 0; f < moving.size(); ++f) {
    for (Vec3d& place : moving[f].position) place.z = static_cast<double>(f);
  }
  const auto statistics = ComputeMotionStatistics(moving, 1, target);
  ASSERT_TRUE(statistics.has_value());
  // At z = 0 and 2: 1, 4, 1 + 2, 1 + sqrt(13).
  EXPECT_NEAR((*statistics)[statistics->size() - 5], (3 + 4) / 2.0, 1e-12);
}

TEST(MotionStatistics, HaveNoValueWithoutNeighboursOrFrames) {
  const FramePositions alone{{1}, {{0, 0, 0}}}, pair{{1, 2}, {{0, 0, 0}, {1, 0, 0}}};
  EXPECT_FALSE(ComputeMotionStatistics(std::vector{alone, alone, alone}, 1).has_value());
  EXPECT_FALSE(ComputeMotionStatistics(std::vector{pair, pair}, 1).has_value());
}

// Statistics that are linear in log theta, with noise of sd 0.1 that is different in each: the sd
// of the estimate is that of least squares. The third parameter is felt by nothing.
std::optional<MotionStatistics> LinearStatistics(const std::vector<double>& theta,
                                                 std::uint64_t seed) {
  MotionStatistics s{};
  Rng rng(seed, 5);
  for (std::size_t k = 0; k < s.size(); ++k) {
    s[k] = (k % 2 == 0 ? 1 : 0.3) * std::log(theta[0]) +
           (k % 2 == 0 ? 0.2 : 1) * std::log(theta[1]) + 0.1 * rng.Normal();
  }
  return s;
}

TEST(SimulatedFit, OfLinearStatisticsHasTheSdOfLeastSquares) {
  const std::vector<double> truth = {2, 0.7, 1};
  double squares[2] = {0, 0};
  double sd[2] = {0, 0};
  constexpr int kSeeds = 40;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SimulatedFitOptions options;
    options.seed = 10000 * seed;
    options.search = SimulatedSearch::kBobyqa;
    options.spread_seeds = 100;
    options.local_evaluations = 60;
    const SimulatedFit fit =
        FitSimulated(options, LinearStatistics, *LinearStatistics(truth, seed), {1, 1, 1});
    ASSERT_TRUE(fit.usable);
    EXPECT_TRUE(std::isinf(fit.log_sd[2]) || fit.log_sd[2] > 1) << fit.log_sd[2];
    for (int k = 0; k < 2; ++k) {
      squares[k] += std::pow(std::log(fit.estimate[k] / truth[k]), 2) / kSeeds;
      sd[k] += fit.log_sd[k] / kSeeds;
    }
  }
  // No less, that is: BOBYQA tries parameters on its way that are as good.
  for (int k = 0; k < 2; ++k) {
    EXPECT_LT(std::sqrt(squares[k]), 1.3 * sd[k]) << k;
    EXPECT_GT(std::sqrt(squares[k]), 0.1 * sd[k]) << k;
  }
}

// Statistics of the product alone: along the ridge nothing is known, however sharp J is across it;
// and of what lies beyond the search's bounds nothing either.
TEST(SimulatedFit, FlagsARidgeAndAnEnd) {
  const auto product = [](const std::vector<double>& theta, std::uint64_t seed) {
    MotionStatistics s{};
    Rng rng(seed, 5);
    for (std::size_t k = 0; k < s.size(); ++k) {
      s[k] = std::log(theta[0] * theta[1]) + (k % 2 == 0 ? 1 : 0) * std::log(theta[2]) +
             0.02 * rng.Normal();
    }
    return std::optional(s);
  };
  SimulatedFitOptions options;
  options.range = 3;
  const SimulatedFit fit = FitSimulated(options, product, *product({1.3, 0.8, 5}, 1), {1, 1, 1});
  ASSERT_TRUE(fit.usable);
  EXPECT_TRUE(std::isinf(fit.log_sd[0]));
  EXPECT_TRUE(std::isinf(fit.log_sd[1]));
  EXPECT_TRUE(std::isinf(fit.log_sd[2]));
}

// Statistics that are as good at log theta_0 = 0.2 as at -0.8, with a hill between, at which
// theta_1 has to be another too: the bend of J at either tells nothing of the other. Theta_2 is
// known.
TEST(SimulatedFit, FlagsWhatIsMatchedFarAwayToo) {
  const auto wells = [](const std::vector<double>& theta, std::uint64_t seed) {
    MotionStatistics s{};
    Rng rng(seed, 5);
    const double well = std::pow(std::log(theta[0]) + 0.3, 2);
    const double along = std::log(theta[1]) + 0.5 * std::log(theta[0]);
    for (std::size_t k = 0; k < s.size(); ++k) {
      const double of[] = {well, along, std::log(theta[2])};
      s[k] = of[k % 3] + 0.01 * rng.Normal();
    }
    return std::optional(s);
  };
  const std::vector<double> truth = {std::exp(0.2), std::exp(-0.1), std::exp(0.1)};
  const std::vector<double> other = {std::exp(-0.8), std::exp(0.4), std::exp(0.1)};
  for (const SimulatedSearch search : {SimulatedSearch::kBobyqa, SimulatedSearch::kCrs}) {
    SimulatedFitOptions options;
    options.search = search;
    const SimulatedFit fit = FitSimulated(options, wells, *wells(truth, 77), {1, 1, 1});
    const SimulatedFit again = FitSimulated(options, wells, *wells(truth, 77), {1, 1, 1});
    ASSERT_TRUE(fit.usable);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LT(std::abs(std::log(fit.estimate[k] / truth[k])), 3 * fit.log_sd[k]) << k;
      EXPECT_LT(std::abs(std::log(fit.estimate[k] / other[k])), 3 * fit.log_sd[k]) << k;
    }
    EXPECT_GT(1.96 * fit.log_sd[0], options.known);
    EXPECT_GT(1.96 * fit.log_sd[1], options.known);
    EXPECT_LT(1.96 * fit.log_sd[2], options.known);
    EXPECT_EQ(fit.log_sd, again.log_sd);
  }
}

TEST(SimulatedFit, EverySearchEndsAtTheTruthOfStatisticsWithoutNoise) {
  const auto exact = [](const std::vector<double>& theta, std::uint64_t) {
    MotionStatistics s{};
    for (std::size_t k = 0; k < s.size(); ++k) {
      s[k] = std::pow(theta[0], 1.0 + static_cast<double>(k % 3)) +
             static_cast<double>(k % 5) * theta[1];
    }
    return std::optional(s);
  };
  for (const SimulatedSearch search :
       {SimulatedSearch::kBobyqa, SimulatedSearch::kCrs, SimulatedSearch::kIsres}) {
    SimulatedFitOptions options;
    options.search = search;
    const SimulatedFit fit = FitSimulated(options, exact, *exact({1.7, 0.6}, 1), {1, 1});
    const SimulatedFit again = FitSimulated(options, exact, *exact({1.7, 0.6}, 1), {1, 1});
    ASSERT_TRUE(fit.usable);
    EXPECT_NEAR(fit.estimate[0], 1.7, 0.02);
    EXPECT_NEAR(fit.estimate[1], 0.6, 0.03);
    EXPECT_EQ(fit.estimate, again.estimate);
    EXPECT_LT(fit.cost, 1e-2 * fit.start_cost);
  }
}

// Statistics without noise whose truth lies at the end of the legal range; what it is at is known.
TEST(SimulatedFit, KeepsToTheLegalRange) {
  double most = 0;
  const auto exact = [&most](const std::vector<double>& theta, std::uint64_t) {
    MotionStatistics s{};
    most = std::max(most, theta[0]);
    for (std::size_t k = 0; k < s.size(); ++k) {
      s[k] = (k % 2 == 0 ? theta[0] : 1) * std::pow(theta[1], static_cast<double>(k % 3));
    }
    return std::optional(s);
  };
  const auto data = *exact({1.2, 0.8}, 1);  // beyond the range
  most = 0;
  SimulatedFitOptions options;
  options.search = SimulatedSearch::kBobyqa;
  options.legal = {{.low = 0, .high = 1}, {.low = 0}};
  const SimulatedFit fit = FitSimulated(options, exact, data, {0.5, 1});
  ASSERT_TRUE(fit.usable);
  EXPECT_LT(most, 1.11);  // the slopes of the statistics alone are taken on either side
  EXPECT_NEAR(fit.estimate[0], 1, 0.01);
  EXPECT_TRUE(std::isfinite(fit.log_sd[0]));
}

TEST(SimulatedFit, ChecksWhatItStartsFrom) {
  EXPECT_THROW(FitSimulated({}, LinearStatistics, {}, {0}), std::invalid_argument);
  const auto none = [](const std::vector<double>&, std::uint64_t) {
    return std::optional<MotionStatistics>();
  };
  EXPECT_FALSE(FitSimulated({}, none, {}, {1}).usable);
}

Scene FliesScene(std::uint64_t seed) {
  Scene scene;
  scene.seed = seed;
  scene.fps = 20;
  scene.substeps = 1;
  scene.duration = 2;
  scene.warmup = 2;
  scene.box = {{-0.5, -0.5, 0.5}, {0.5, 0.5, 1.5}};
  SpeciesSpec flies;
  flies.count = 25;
  flies.speed = 0.3;
  flies.wingspan = 0.005;
  flies.body_length = 0.003;
  flies.model.name = "bswarm";
  flies.model.parameters = {{"r_rep", 0.08}, {"r_ali", 0.2}, {"r_att", 0.5},     {"w_rep", 1},
                            {"w_ali", 0.2},  {"w_att", 0.3}, {"curl_gain", 0},   {"noise", 0.5},
                            {"alpha_b", 12}, {"drive", 2},   {"wall_taper", 0.1}};
  flies.model.choices["avoid"] = "none";
  scene.species = {flies};
  return scene;
}

TEST(StatisticsFit, MatchesBswarmAndFlagsWhatStatisticsDoNotFeel) {
  const Scene scene = FliesScene(3);
  FitProblem problem;
  problem.model = scene.species[0].model;
  problem.model.parameters["w_att"] = 0.9;  // where the search starts: three times the truth
  problem.free = {"w_att", "escape"};       // there is no predator to escape from
  problem.walls = scene.box;
  problem.search = SimulatedSearch::kBobyqa;
  FitOptions options;
  options.substeps = 1;
  options.statistics_time = 1.5;
  options.local_evaluations = 25;
  const Trajectories flock = Fly(scene);
  const FitResult one = FitModel(options, problem, flock, 20, 1, 1);
  const FitResult two = FitModel(options, problem, flock, 20, 1, 2);
  ASSERT_TRUE(one.IsUsable());
  EXPECT_EQ(one.method, FitMethod::kStatistics);
  ASSERT_EQ(one.weights.size(), 2U);
  EXPECT_FALSE(one.weights[1].determined);
  EXPECT_LT(std::abs(std::log(one.weights[0].value / 0.3)),
            3 * one.weights[0].sd / one.weights[0].value);
  ASSERT_EQ(one.misfit.size(), kMotionStatistics.size() - 1);  // there is nothing to fly to
  for (const auto& [name, misfit] : one.misfit) EXPECT_LT(misfit, 3) << name;
  EXPECT_EQ(one.weights[0].value, two.weights[0].value);
  EXPECT_EQ(one.weights[0].sd, two.weights[0].sd);
}

TEST(StatisticsFit, RefusesWhatItCannotStartFrom) {
  const Trajectories flock = Fly(FliesScene(1));
  FitProblem problem;
  problem.model.name = "bswarm";
  problem.free = {"noise"};  // 0 by default
  EXPECT_THROW(FitModel({}, problem, flock, 20, 1, 1), InputError);
  problem.free = {"no_such"};
  EXPECT_THROW(FitModel({}, problem, flock, 20, 1, 1), InputError);
  problem.method = FitMethod::kStatistics;
  problem.model.name = "boids";
  problem.free.clear();
  EXPECT_THROW(FitModel({}, problem, flock, 20, 1, 1), InputError);
}

}  // namespace
}  // namespace flocklift
