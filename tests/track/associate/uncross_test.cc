// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/uncross.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "simulate/core/rng.h"
#include "track/associate/join_cost.h"

namespace flocklift {
namespace {

const MotionNoise kNoise{.acceleration = 0.02, .measurement = 0.05, .speed_sd = 5};

// The track that follows `before` up to frame 20 and `after` from frame 21 on; frames 18 to 22 are
// of one blob.
TrackRecord Track(const std::function<Vec2d(int)>& before, const std::function<Vec2d(int)>& after,
                  bool meets = true) {
  std::vector<TrackPoint> sightings;
  for (int frame = 1; frame <= 40; ++frame) {
    Rng rng(3, static_cast<std::uint64_t>(frame));
    Vec2d p = frame <= 20 ? before(frame) : after(frame);
    p = {p.x + 0.1 * rng.Normal(), p.y + 0.1 * rng.Normal()};
    const bool shared = meets && frame >= 18 && frame <= 22;
    sightings.push_back({.frame = frame,
                         .position = p,
                         .variance = 0.08,
                         .box = Box::Around(p, 9, 7),
                         .shape = {8, 6, 0, 25},
                         .shared = shared,
                         .hidden = shared,
                         .blob = shared ? 3 : -1});
  }
  return {.size = 5, .mass = 1000, .sightings = Sightings(std::move(sightings)), .doubts = {}};
}

Vec2d Down(int t) { return {100 + 4.0 * t, 200 + 1.0 * t}; }
Vec2d Up(int t) { return {100 + 4.0 * t, 240 - 1.0 * t}; }

bool IsStraight(const TrackRecord& track) {
  const std::vector<TrackPoint> all = track.sightings.All();
  const double before = all[10].position.y - all[0].position.y;
  const double after = all[39].position.y - all[29].position.y;
  return before * after > 0;
}

TEST(UncrossTest, UndoesAnExchange) {
  std::vector<TrackRecord> tracks{Track(Down, Up), Track(Up, Down)};
  EXPECT_EQ(Uncross(kNoise, &tracks), 1);
  EXPECT_TRUE(IsStraight(tracks[0]));
  EXPECT_TRUE(IsStraight(tracks[1]));
  const std::vector<TrackPoint> all = tracks[0].sightings.All();
  ASSERT_EQ(all.size(), 40u);
  for (int k = 0; k < 40; ++k) EXPECT_EQ(all[k].frame, k + 1);
}

TEST(UncrossTest, LeavesWhatIsRight) {
  std::vector<TrackRecord> tracks{Track(Down, Down), Track(Up, Up)};
  EXPECT_EQ(Uncross(kNoise, &tracks), 0);
  EXPECT_TRUE(IsStraight(tracks[0]));
}

TEST(UncrossTest, TracksThatNeverMetAreNotAsked) {
  std::vector<TrackRecord> tracks{Track(Down, Up, false), Track(Up, Down, false)};
  EXPECT_EQ(Uncross(kNoise, &tracks), 0);
}

// One axis by hand: P_a = P_b = diag(1, 1), one frame, q = 0: C = [2 1; 1 1] + diag(1, 1).
TEST(JoinCostTest, ByHand) {
  const MotionState a{{0, 0}, {2, 0}, 1, 0, 1}, b{{3, 0}, {2, 0}, 1, 0, 1};
  const JoinCost join = CostOfJoin(a, b, 0, 1);
  // C = [3 1; 1 2], |C| = 5; e = (1, 0) along x and 0 along y: e' C^-1 e = 2/5.
  EXPECT_NEAR(join.squared_distance, 0.4, 1e-12);
  EXPECT_NEAR(join.cost, 0.2 + 2 * std::log(2 * 3.14159265358979) + std::log(5.0), 1e-9);
}

}  // namespace
}  // namespace flocklift
