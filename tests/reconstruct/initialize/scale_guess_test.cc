// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/scale_guess.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/reconstruct/circling_flock.h"

namespace flocklift {
namespace {

class ScaleGuessTest : public testing::Test {
 protected:
  ScaleGuessTest() {
    const Camera camera = WatchingCamera();
    segments_ = MakeSegments({}, Observe(flock_, {}, CirclingFlock(flock_), camera), camera, 30);
  }
  FlockSpec flock_;
  Segments segments_;
};

// The flock is 35 to 60 m away, 47 m in the mean.
TEST_F(ScaleGuessTest, EveryPriorFixesIt) {
  Knowledge wingspan, speed, range;
  wingspan.wingspan = Uncertain{flock_.wingspan, 0.03};
  speed.speed = Uncertain{flock_.speed, 1};
  range.near = 30;
  range.far = 70;
  for (const Knowledge& knowledge : {wingspan, speed, range}) {
    const ScaleGuess guess = GuessScale(knowledge, segments_);
    EXPECT_NEAR(guess.log_depth, std::log(47.0), 0.35);
    EXPECT_NEAR(guess.log_speed, std::log(flock_.speed), 0.5);
    EXPECT_NEAR(guess.log_width, std::log(flock_.wingspan), 0.4);
    EXPECT_LT(guess.log_near, std::log(37.0));
    EXPECT_GT(guess.log_far, std::log(57.0));
    EXPECT_GT(guess.lateral_spread, 0.01);
    EXPECT_LT(guess.lateral_spread, 0.5);
  }
  EXPECT_EQ(GuessScale(range, segments_).log_near, std::log(30.0));
  EXPECT_EQ(GuessScale(range, segments_).log_far, std::log(70.0));
}

TEST_F(ScaleGuessTest, BoundsNeverCross) {
  for (double near : {1.0, 1000.0}) {
    Knowledge knowledge;
    knowledge.speed = Uncertain{flock_.speed, 1};
    knowledge.near = near;
    const ScaleGuess guess = GuessScale(knowledge, segments_);
    EXPECT_LT(guess.log_near, guess.log_far);
    EXPECT_GE(guess.log_depth, guess.log_near);
  }
}

TEST(ScaleGuess, OneSightingIsEnough) {
  Segments segments;
  Sighting sighting;
  sighting.frame = 1;
  segments.segments = {{1, {sighting}}};
  Knowledge knowledge;
  knowledge.speed = Uncertain{10, 1};
  const ScaleGuess guess = GuessScale(knowledge, segments);
  EXPECT_TRUE(std::isfinite(guess.log_depth));
  EXPECT_LT(guess.log_near, guess.log_far);
}

}  // namespace
}  // namespace flocklift
