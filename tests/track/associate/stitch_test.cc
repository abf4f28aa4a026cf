// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/stitch.h"

#include <gtest/gtest.h>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

const MotionNoise kNoise{.acceleration = 0.02, .measurement = 0.05, .speed_sd = 5};

TrackRecord Straight(const Vec2d& start, const Vec2d& velocity, int first, int last) {
  std::vector<TrackPoint> sightings;
  for (int frame = first; frame <= last; ++frame) {
    Rng rng(3, static_cast<std::uint64_t>(frame));
    sightings.push_back({.frame = frame,
                         .position = {start.x + velocity.x * frame + 0.1 * rng.Normal(),
                                      start.y + velocity.y * frame + 0.1 * rng.Normal()},
                         .variance = 0.08,
                         .box = Box::Around({0, 0}, 9, 7)});
  }
  return {.size = 5, .mass = 1000, .sightings = Sightings(std::move(sightings)), .doubts = {}};
}

std::vector<TrackRecord> StitchThem(std::vector<TrackRecord> tracks, int* joins,
                                    const StitchOptions& options = {}) {
  return Stitch(options, kNoise, 1280, 720, std::move(tracks), joins);
}

TEST(StitchTest, JoinsOverAGap) {
  int joins = 0;
  const auto tracks = StitchThem(
      {Straight({100, 100}, {3, 1}, 1, 20), Straight({100, 100}, {3, 1}, 35, 60)}, &joins);
  EXPECT_EQ(joins, 1);
  ASSERT_EQ(tracks.size(), 1u);
  EXPECT_EQ(tracks[0].sightings.size(), 46u);
}

TEST(StitchTest, DoesNotJoinWhatIsElsewhereOrMovesOtherwise) {
  int joins = 0;
  EXPECT_EQ(StitchThem({Straight({100, 100}, {3, 1}, 1, 20), Straight({100, 400}, {3, 1}, 35, 60)},
                       &joins)
                .size(),
            2u);
  EXPECT_EQ(StitchThem({Straight({100, 100}, {3, 1}, 1, 20), Straight({310, 100}, {-3, 1}, 35, 60)},
                       &joins)
                .size(),
            2u);
  EXPECT_EQ(joins, 0);
}

TEST(StitchTest, KeepsToTheLongestGap) {
  const std::vector<TrackRecord> tracks{Straight({100, 100}, {3, 1}, 1, 20),
                                        Straight({100, 100}, {3, 1}, 35, 60)};
  int joins = 0;
  EXPECT_EQ(StitchThem(tracks, &joins, {.max_gap = 14}).size(), 2u);
  EXPECT_EQ(StitchThem(tracks, &joins, {.max_gap = 15}).size(), 1u);
  EXPECT_EQ(StitchThem(tracks, &joins, {.max_gap = 0}).size(), 2u);
}

// Two animals cross inside the gap: the greedy choice by distance alone would swap them.
TEST(StitchTest, TwoGapsThatCrossAreTold) {
  int joins = 0;
  const auto tracks =
      StitchThem({Straight({100, 100}, {4, 1}, 1, 20), Straight({100, 150}, {4, -1}, 1, 20),
                  Straight({100, 100}, {4, 1}, 30, 50), Straight({100, 150}, {4, -1}, 30, 50)},
                 &joins);
  EXPECT_EQ(joins, 2);
  ASSERT_EQ(tracks.size(), 2u);
  for (const TrackRecord& track : tracks) {
    const std::vector<TrackPoint> sightings = track.sightings.All();
    const bool down = sightings[10].position.y > sightings[0].position.y;
    const auto& last = sightings.back().position;
    EXPECT_NEAR(last.y, down ? 150 : 100, 2);
  }
}

TEST(StitchTest, ChainsOfThree) {
  int joins = 0;
  const auto tracks =
      StitchThem({Straight({100, 100}, {3, 1}, 1, 20), Straight({100, 100}, {3, 1}, 25, 40),
                  Straight({100, 100}, {3, 1}, 50, 70)},
                 &joins);
  EXPECT_EQ(joins, 2);
  ASSERT_EQ(tracks.size(), 1u);
  EXPECT_EQ(tracks[0].sightings.last_frame(), 70);
}

}  // namespace
}  // namespace flocklift
