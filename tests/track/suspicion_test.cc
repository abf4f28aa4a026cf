// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/suspicion.h"

#include <gtest/gtest.h>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

const MotionNoise kNoise{.acceleration = 0.02, .measurement = 0.05, .speed_sd = 5};
const Footage kFootage{.width = 1280, .height = 720, .first_frame = 1, .last_frame = 60};

constexpr double kSize = 5;

std::vector<TrackPoint> Straight(int first, int last) {
  std::vector<TrackPoint> track;
  for (int frame = first; frame <= last; ++frame) {
    Rng rng(3, static_cast<std::uint64_t>(frame));
    track.push_back({.frame = frame,
                     .position = {300 + 4.0 * frame + 0.1 * rng.Normal(), 300 + 0.1 * rng.Normal()},
                     .variance = 0.08,
                     .box = Box::Around({0, 0}, 9, 7)});
  }
  return track;
}

TEST(SuspicionTest, ACleanTrackIsNotSuspected) {
  std::vector<TrackPoint> track = Straight(1, 60);
  EXPECT_TRUE(DoubtsOf(kNoise, kFootage, {}, kSize, track).empty());
}

TEST(SuspicionTest, AJumpIsFoundWhereItIs) {
  std::vector<TrackPoint> track = Straight(1, 60);
  for (int k = 30; k < 60; ++k) track[k].position.y += 12;
  const std::vector<Doubt> doubts = DoubtsOf(kNoise, kFootage, {}, kSize, track);
  ASSERT_FALSE(doubts.empty());
  EXPECT_EQ(doubts[0].kind, DoubtKind::kJump);
  EXPECT_EQ(doubts[0].first_frame, 30);
  EXPECT_EQ(doubts[0].last_frame, 31);
}

TEST(SuspicionTest, BeginningsAndEndsInsideThePictureAreBreaks) {
  std::vector<TrackPoint> track = Straight(20, 40);
  const std::vector<Doubt> doubts = DoubtsOf(kNoise, kFootage, {}, kSize, track);
  ASSERT_EQ(doubts.size(), 2u);
  for (const Doubt& d : doubts) EXPECT_EQ(d.kind, DoubtKind::kBreak);
  EXPECT_EQ(doubts[0].first_frame, 20);
  EXPECT_EQ(doubts[1].first_frame, 40);
  // Leaving by the right edge is none.
  std::vector<TrackPoint> leaving = Straight(1, 40);
  Footage narrow = kFootage;
  narrow.width = 480;
  EXPECT_TRUE(DoubtsOf(kNoise, narrow, {}, kSize, leaving).empty());
}

TEST(SuspicionTest, ALongStayBehindAnother) {
  std::vector<TrackPoint> track = Straight(1, 60);
  for (int k = 20; k < 36; ++k) track[k].hidden = true;
  const std::vector<Doubt> doubts = DoubtsOf(kNoise, kFootage, {}, kSize, track);
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_EQ(doubts[0].kind, DoubtKind::kMerge);
  EXPECT_EQ(doubts[0].first_frame, 21);
  EXPECT_EQ(doubts[0].last_frame, 36);
}

TEST(SuspicionTest, RanksByChanceAndJoinsTheTwoOfAnEncounter) {
  TrackRecord a, b, dropped;
  const Doubt swap{DoubtKind::kSwap, 10, 12, {5, 6}, 0.4};
  const Doubt jump{DoubtKind::kJump, 20, 21, {7, 8}, 0.7};
  const Doubt slight{DoubtKind::kJoin, 20, 25, {7, 8}, 0.01};
  a.doubts = {swap, slight};
  b.doubts = {swap, jump};
  dropped.doubts = {{DoubtKind::kBreak, 5, 5, {1, 1}, 0.9}};
  const std::vector<TrackRecord> records{a, b, dropped};
  const std::vector<Id> ids{4, 9, kNoId};
  const std::vector<Suspicion> ranked = RankSuspicions(records, ids);
  ASSERT_EQ(ranked.size(), 2u);
  EXPECT_EQ(ranked[0].doubt.kind, DoubtKind::kJump);
  EXPECT_EQ(ranked[0].ids, std::vector<Id>{9});
  EXPECT_EQ(ranked[1].doubt.kind, DoubtKind::kSwap);
  EXPECT_EQ(ranked[1].ids, (std::vector<Id>{4, 9}));
}

}  // namespace
}  // namespace flocklift
