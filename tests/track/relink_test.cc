// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/relink.h"

#include <gtest/gtest.h>

#include <functional>

namespace flocklift::internal {
namespace {

TrackRows Rows(const std::function<Vec2d(int)>& at, int first, int last) {
  TrackRows rows;
  for (int frame = first; frame <= last; ++frame) {
    Detection d;
    d.frame = frame;
    d.box = Box::Around(at(frame), 8, 6);
    rows.emplace(frame, d);
  }
  return rows;
}

// They cross in frame 20.
Vec2d Down(int t) { return {10.0 * t, 100 + 5.0 * (t - 20)}; }
Vec2d Up(int t) { return {10.0 * t, 100 - 5.0 * (t - 20)}; }

// The first follows Down up to the crossing and Up afterwards, the second the other way round.
std::map<Id, TrackRows> Swapped() {
  return {{1, Rows([](int t) { return t <= 20 ? Down(t) : Up(t); }, 1, 40)},
          {2, Rows([](int t) { return t <= 20 ? Up(t) : Down(t); }, 1, 40)}};
}

void ExpectFollows(const TrackRows& rows, const std::function<Vec2d(int)>& truth, int first,
                   int last) {
  for (int frame = first; frame <= last; ++frame) {
    ASSERT_TRUE(rows.contains(frame)) << frame;
    EXPECT_NEAR(rows.at(frame).box.Center().x, truth(frame).x, 1e-9) << frame;
    EXPECT_NEAR(rows.at(frame).box.Center().y, truth(frame).y, 1e-9) << frame;
  }
}

TEST(RelinkTest, APinOnTheOtherUndoesASwapWhereItHappened) {
  for (const int frame : {22, 30, 40}) {
    std::map<Id, TrackRows> tracks = Swapped();
    Id next = 3;
    Relink(1, {frame, Down(frame)}, {}, &tracks, &next);
    ExpectFollows(tracks.at(1), Down, 1, 40);
    ExpectFollows(tracks.at(2), Up, 1, 40);
    EXPECT_EQ(next, 3);
  }
}

// After an earlier pin in frame 33 the path is known to be right there.
TEST(RelinkTest, TurnsBackBeforeTheNextPin) {
  // They meet in frame 25; before, the first was with the second.
  const auto b = [](int t) {
    return Vec2d{10.0 * t, t < 20 ? 160 - 3.0 * t : 100.0 + 3 * (t - 20)};
  };
  const auto a = [](int t) {
    return Vec2d{10.0 * t, t < 30 ? 190 - 3.0 * t : 100.0 + 9 * (t - 30)};
  };
  std::map<Id, TrackRows> tracks{{1, Rows([&](int t) { return t >= 26 ? a(t) : b(t); }, 15, 45)},
                                 {2, Rows([&](int t) { return t >= 26 ? b(t) : a(t); }, 15, 45)}};
  // In truth animal 1 is `a` throughout; frame 33 was pinned to it.
  Id next = 3;
  Relink(1, {18, a(18)}, {33}, &tracks, &next);
  ExpectFollows(tracks.at(1), a, 26, 45);
  EXPECT_EQ(tracks.at(1).at(18).box.Center(), a(18));
  ExpectFollows(tracks.at(2), b, 26, 45);
}

TEST(RelinkTest, TakesUpATrackThatBeganAnew) {
  std::map<Id, TrackRows> tracks{{1, Rows(Down, 1, 15)}, {2, Rows(Down, 19, 40)}};
  Id next = 3;
  Relink(1, {25, Down(25)}, {}, &tracks, &next);
  EXPECT_FALSE(tracks.contains(2));
  ExpectFollows(tracks.at(1), Down, 1, 40);
  EXPECT_LT(tracks.at(1).at(17).confidence, kMeasuredConfidence);
  EXPECT_EQ(tracks.at(1).at(25).confidence, 1);
}

// The track had wandered off to something else.
TEST(RelinkTest, GivesAwayRowsFromWhichThePinCannotBeReached) {
  std::map<Id, TrackRows> tracks{{1, Rows(
                                         [](int t) {
                                           return t <= 20 || t >= 31 ? Down(t) : Vec2d{900, 700};
                                         },
                                         1, 40)}};
  Id next = 7;
  Relink(1, {25, Down(25)}, {}, &tracks, &next);
  ExpectFollows(tracks.at(1), Down, 1, 40);
  EXPECT_EQ(next, 8);
  ASSERT_TRUE(tracks.contains(7));
  EXPECT_EQ(tracks.at(7).size(), 10u);
  EXPECT_EQ(tracks.at(7).begin()->first, 21);
}

TEST(RelinkTest, APinOnItsOwnRowMovesThatAlone) {
  std::map<Id, TrackRows> tracks = Swapped();
  Id next = 3;
  Relink(1, {10, {Down(10).x + 1, Down(10).y + 2}}, {}, &tracks, &next);
  ExpectFollows(tracks.at(1), Down, 1, 9);
  EXPECT_EQ(tracks.at(1).at(10).box.Center(), (Vec2d{Down(10).x + 1, Down(10).y + 2}));
  ExpectFollows(tracks.at(1), Down, 11, 20);
}

}  // namespace
}  // namespace flocklift::internal
