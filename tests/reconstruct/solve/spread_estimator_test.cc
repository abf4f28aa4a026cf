// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/spread_estimator.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "simulate/core/rng.h"

namespace flocklift::internal {
namespace {

constexpr double kKnotInterval = 0.1;

Spreads Guess(double speed_sd) {
  Spreads spreads;
  spreads.speed = {speed_sd, 1};
  spreads.turn = {0.5, 1};
  return spreads;
}

// Two animals, one of half a second: 1.5 of them, against a first guess worth four.
TEST(SpreadEstimator, ByHand) {
  const Spreads guess = Guess(0.2);
  SpreadEstimator one(guess), other(guess);
  one.BeginAnimal(10);
  one.Add(Term::kSpeed, 0.3, 0.01);
  one.Add(Term::kSpeed, -0.1, 0.02);
  other.BeginAnimal(0.5);
  other.Add(Term::kSpeed, 0.5, 0.03);
  one.Merge(other);
  Spreads next = guess;
  one.Update(guess, kKnotInterval, &next);
  const double mean = (0.09 + 0.01 + 0.25) / 3;
  const double seen = 1 - (0.01 + 0.02 + 0.03) / 3 / 0.04;
  EXPECT_NEAR(next.speed.sd, std::sqrt((1.5 * mean + 4 * 0.04) / (1.5 * seen + 4)), 1e-12);
  EXPECT_EQ(next.turn.sd, guess.turn.sd);  // of which nothing was said
}

// 10.5 seconds of errors of size that last 0.5 s: 10.5 of them, one a second; a bias once a bird.
TEST(SpreadEstimator, ShortErrorsAreToldOften) {
  Spreads guess = Guess(0.2);
  guess.size = {0.2, 0.5};
  SpreadEstimator estimator(guess);
  for (const double duration : {10.0, 0.5}) {
    estimator.BeginAnimal(duration);
    estimator.Add(Term::kSize, 0.1, 0);
    estimator.Add(Term::kSizeSpread, 0.1, 0);
  }
  Spreads next = guess;
  estimator.Update(guess, kKnotInterval, &next);
  EXPECT_NEAR(next.size.sd, std::sqrt((10.5 * 0.01 + 4 * 0.04) / 14.5), 1e-12);
  EXPECT_NEAR(next.size_between, std::sqrt((1.5 * 0.01 + 4 * 0.0025) / 5.5), 1e-12);
  guess.size.time = 20;  // longer than they are seen
  SpreadEstimator lasting(guess);
  lasting.BeginAnimal(10);
  lasting.Add(Term::kSize, 0.1, 0);
  lasting.Update(guess, kKnotInterval, &next);
  EXPECT_NEAR(next.size.sd, std::sqrt((1 * 0.01 + 4 * 0.04) / 5), 1e-12);
  guess.size.time = 1e-3;  // shorter than knots are apart
  SpreadEstimator brief(guess);
  brief.BeginAnimal(10 * kKnotInterval);
  brief.Add(Term::kSize, 0.1, 0);
  brief.Update(guess, kKnotInterval, &next);
  EXPECT_NEAR(next.size.sd, std::sqrt((10 * 0.01 + 4 * 0.04) / 14), 1e-12);
}

TEST(SpreadEstimator, OutliersAndVaguePosteriorsAreBounded) {
  const Spreads guess = Guess(0.1);
  SpreadEstimator estimator(guess);
  estimator.BeginAnimal(10);
  estimator.Add(Term::kSpeed, 1, 5);  // 10 sds, of which Huber's loss counts 3
  Spreads next = guess;
  estimator.Update(guess, kKnotInterval, &next);
  EXPECT_NEAR(next.speed.sd, std::sqrt((0.3 + 4 * 0.01) / 4), 1e-12);
}

// Where expectation maximisation stands still, so does this.
TEST(SpreadEstimator, StandsWhereTheEvidenceIsGreatest) {
  const Spreads guess = Guess(0.2);
  Spreads now = guess;
  now.speed.sd = 0.1;
  const double variance = 0.004;
  const double square = (11 * 0.01 - 4 * 0.04) / 7 + 0.02;  // of seven animals
  ASSERT_GT(square, variance);
  now.speed.sd = std::sqrt((7 * square + 4 * 0.04) / 11);
  SpreadEstimator estimator(now);
  for (int animal = 0; animal < 7; ++animal) {
    estimator.BeginAnimal(10);
    estimator.Add(Term::kSpeed, std::sqrt(square - variance), variance);
  }
  Spreads next = now;
  estimator.Update(guess, kKnotInterval, &next);
  EXPECT_NEAR(next.speed.sd, now.speed.sd, 1e-12);
}

// Errors of sd 0.04 between animals that are measured to 0.1 each: the marginal likelihood of what
// was measured tells their spread, in a few rounds, although each error by itself is hardly seen.
TEST(SpreadEstimator, FindsASpreadBelowTheNoiseInAFewRounds) {
  constexpr int kAnimals = 4000;
  constexpr double kNoise = 0.1, kSpread = 0.04;
  Rng rng(3, 1);
  std::array<double, kAnimals> measured;
  double squares = 0;
  for (double& m : measured) {
    m = kSpread * rng.Normal() + kNoise * rng.Normal();
    squares += m * m / kAnimals;
  }
  Spreads guess;
  guess.speed_between = 0.1;
  Spreads now = guess;
  for (int round = 0; round < 8; ++round) {
    SpreadEstimator estimator(now);
    const double prior = now.speed_between * now.speed_between;
    const double share = prior / (prior + kNoise * kNoise);
    for (const double m : measured) {
      estimator.BeginAnimal(10);
      estimator.Add(Term::kSpeedSpread, share * m, share * kNoise * kNoise);
    }
    estimator.Update(guess, kKnotInterval, &now);
  }
  const double likeliest = std::sqrt(squares - kNoise * kNoise);
  EXPECT_NEAR(now.speed_between, likeliest, 0.012);  // expectation maximisation: 0.023 off
  EXPECT_NEAR(likeliest, kSpread, 0.008);
}

TEST(SpreadEstimator, SizesDifferAtLeastAsStated) {
  Spreads guess = Guess(0.1);
  guess.size_between = 0.05;
  for (const double error : {0.01, 0.12}) {
    SpreadEstimator estimator(guess);
    for (int animal = 0; animal < 60; ++animal) {
      estimator.BeginAnimal(10);
      estimator.Add(Term::kSizeSpread, animal % 2 == 0 ? error : -error, 0);
    }
    Spreads next = guess;
    estimator.Update(guess, kKnotInterval, &next);
    const double wider = std::sqrt((60 * 0.0144 + 4 * 0.0025) / 64);
    EXPECT_NEAR(next.size_between, error < 0.05 ? 0.05 : wider, 1e-12);
  }
}

// Many animals whose errors are known: theirs is the spread, whatever was guessed, within a factor
// of ten.
TEST(SpreadEstimator, ManyAnimalsOutweighTheGuess) {
  const Spreads guess = Guess(0.1);
  Spreads next = guess;
  for (int round = 0; round < 5; ++round) {
    SpreadEstimator estimator(next);
    for (std::uint64_t animal = 0; animal < 400; ++animal) {
      estimator.BeginAnimal(10);
      Rng rng(1, animal);
      for (int k = 0; k < 20; ++k) estimator.Add(Term::kSpeed, 0.25 * rng.Normal(), 0);
    }
    estimator.Update(guess, kKnotInterval, &next);
  }
  EXPECT_NEAR(next.speed.sd, 0.25, 0.01);
}

TEST(SpreadEstimator, APairIsSumAndDifferenceWithDerivatives) {
  ResidualRow a, b;
  a.first = 6;
  a.residual = 2;
  b.first = 9;
  b.residual = 5;
  for (std::size_t k = 0; k < 9; ++k) {  // three control points
    a.path[k] = 1 + static_cast<double>(k);
    b.path[k] = 100 * (1 + static_cast<double>(k));
  }
  a.AddBorder(1, 7);
  b.AddBorder(4, 11);
  b.AddBorder(1, 13);
  const ErrorPair pair(a, b);
  EXPECT_EQ(pair.sum.first, 6);
  EXPECT_EQ(pair.sum.residual, 7);
  EXPECT_EQ(pair.difference.residual, 3);
  const std::array<double, 12> sum = {1, 2, 3, 104, 205, 306, 407, 508, 609, 700, 800, 900};
  const std::array<double, 12> difference = {-1,  -2,  -3,  96,  195, 294,
                                             393, 492, 591, 700, 800, 900};
  EXPECT_EQ(pair.sum.path, sum);
  EXPECT_EQ(pair.difference.path, difference);
  ASSERT_EQ(pair.difference.border_count, 2);
  EXPECT_EQ(pair.sum.border[0], (std::pair<int, double>(1, 20)));
  EXPECT_EQ(pair.difference.border[0], (std::pair<int, double>(1, 6)));
  EXPECT_EQ(pair.difference.border[1], (std::pair<int, double>(4, 11)));
}

// Pairs of a process of variance 0.01 whose correlation is known, as a posterior has them that
// leaves a part of either error open.
TEST(SpreadEstimator, FindsHowLongAnErrorOfSizeLasts) {
  Spreads guess = Guess(0.1);
  guess.size = {0.2, 0.15};
  constexpr double kVariance = 0.01, kOpen = 0.003;
  const double known_sd = std::sqrt(kVariance - kOpen);
  for (const double time : {0.05, 0.15, 0.25}) {
    const double rho = std::exp(-kKnotInterval / time);
    const double of_known = rho * kVariance / (kVariance - kOpen);
    SpreadEstimator estimator(guess);
    for (std::uint64_t animal = 0; animal < 2000; ++animal) {
      estimator.BeginAnimal(10);
      Rng rng(2, animal);
      const double a = known_sd * rng.Normal();
      const double b = of_known * a + known_sd * std::sqrt(1 - of_known * of_known) * rng.Normal();
      estimator.AddSizePair(a + b, 2 * kOpen, b - a, 2 * kOpen);
    }
    Spreads next = guess;
    estimator.Update(guess, kKnotInterval, &next);
    EXPECT_NEAR(next.size.Correlation(kKnotInterval), rho, 0.04);
  }
}

TEST(SpreadEstimator, AnErrorOfSizeMayBeGoneAtTheNextKnot) {
  Spreads guess = Guess(0.1);
  guess.size = {0.1, 0.15};
  SpreadEstimator estimator(guess);
  for (int animal = 0; animal < 40; ++animal) {
    estimator.BeginAnimal(10);
    estimator.AddSizePair(0, 0, 0.1, 0);
  }
  Spreads next = guess;
  estimator.Update(guess, kKnotInterval, &next);
  EXPECT_NEAR(next.size.time, 0.015, 1e-12);  // a tenth of the guess, at least
}

}  // namespace
}  // namespace flocklift::internal
