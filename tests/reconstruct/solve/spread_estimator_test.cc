// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/spread_estimator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulate/core/rng.h"

namespace flocklift::internal {
namespace {

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
  one.Update(guess, &next);
  const double mean = (0.09 + 0.01 + 0.01 + 0.02 + 0.25 + 0.03) / 3;
  EXPECT_NEAR(next.speed.sd, std::sqrt((1.5 * mean + 4 * 0.04) / 5.5), 1e-12);
  EXPECT_EQ(next.turn.sd, guess.turn.sd);  // of which nothing was said
}

TEST(SpreadEstimator, OutliersAndVaguePosteriorsAreBounded) {
  const Spreads guess = Guess(0.1);
  SpreadEstimator estimator(guess);
  estimator.BeginAnimal(10);
  estimator.Add(Term::kSpeed, 1, 5);  // 10 sds, of which Huber's loss counts 3
  Spreads next = guess;
  estimator.Update(guess, &next);
  EXPECT_NEAR(next.speed.sd, std::sqrt((0.3 + 0.09 + 4 * 0.01) / 5), 1e-12);
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
    estimator.Update(guess, &next);
  }
  EXPECT_NEAR(next.speed.sd, 0.25, 0.01);
}

}  // namespace
}  // namespace flocklift::internal
