// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/correct.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr int kFrames = 30;

Tracklet Row(Id id, double y, int first, int last) {
  Tracklet tracklet{id, {}};
  for (int frame = first; frame <= last; ++frame) {
    Detection d;
    d.frame = frame;
    d.box = Box::Around({10.0 * frame, y}, 8, 6);
    tracklet.detections.push_back(d);
  }
  return tracklet;
}

Tracks Example() { return {30.0, {Row(1, 100, 1, 20), Row(2, 200, 5, 25), Row(4, 300, 22, 30)}}; }

Tracks Corrected(const std::string& text) {
  std::istringstream stream(text);
  Tracks tracks = Example();
  ApplyCorrections(ReadCorrections(stream, "c.txt"), "c.txt", kFrames, &tracks);
  return tracks;
}

const Tracklet* Find(const Tracks& tracks, Id id) {
  for (const Tracklet& t : tracks.tracklets) {
    if (t.id == id) return &t;
  }
  return nullptr;
}

const Detection* At(const Tracks& tracks, Id id, int frame) {
  const Tracklet* t = Find(tracks, id);
  if (t == nullptr) return nullptr;
  for (const Detection& d : t->detections) {
    if (d.frame == frame) return &d;
  }
  return nullptr;
}

TEST(CorrectTest, SwapExchangesFromAFrameOn) {
  const Tracks tracks = Corrected("swap 1 2 10\n");
  EXPECT_EQ(At(tracks, 1, 9)->box.Center().y, 100);
  EXPECT_EQ(At(tracks, 1, 10)->box.Center().y, 200);
  EXPECT_EQ(At(tracks, 2, 10)->box.Center().y, 100);
  EXPECT_EQ(Find(tracks, 1)->detections.back().frame, 25);
  EXPECT_EQ(tracks.fps, 30.0);
}

TEST(CorrectTest, SplitMakesANewId) {
  const Tracks tracks = Corrected("split 1 15\n");
  EXPECT_EQ(Find(tracks, 1)->detections.back().frame, 14);
  ASSERT_NE(Find(tracks, 5), nullptr);
  EXPECT_EQ(Find(tracks, 5)->detections.front().frame, 15);
}

TEST(CorrectTest, JoinFillsTheGapAsInterpolated) {
  const Tracks tracks = Corrected("join 1 4\n");
  EXPECT_EQ(Find(tracks, 4), nullptr);
  EXPECT_EQ(Find(tracks, 1)->detections.size(), 30u);
  const Detection* between = At(tracks, 1, 21);
  ASSERT_NE(between, nullptr);
  EXPECT_LT(between->confidence, kMeasuredConfidence);
  EXPECT_DOUBLE_EQ(between->box.Center().y, 200);
  EXPECT_DOUBLE_EQ(between->box.Center().x, 210);
}

TEST(CorrectTest, DeleteAllOrSome) {
  EXPECT_EQ(Find(Corrected("delete 2\n"), 2), nullptr);
  const Tracks tracks = Corrected("delete 2 10 12\n");
  EXPECT_EQ(Find(tracks, 2)->detections.size(), 18u);
  EXPECT_EQ(At(tracks, 2, 11), nullptr);
  EXPECT_NE(At(tracks, 2, 13), nullptr);
}

TEST(CorrectTest, PinMovesOrAddsARow) {
  Tracks tracks = Corrected("pin 1 10 95 92\n");
  EXPECT_EQ(At(tracks, 1, 10)->box.Center(), (Vec2d{95, 92}));
  EXPECT_EQ(At(tracks, 1, 10)->box.width, 8);
  EXPECT_EQ(At(tracks, 1, 11)->box.Center().x, 110);
  tracks = Corrected("pin 1 24 240 140\n");
  EXPECT_EQ(At(tracks, 1, 24)->confidence, 1);
  EXPECT_DOUBLE_EQ(At(tracks, 1, 22)->box.Center().y, 120);
  EXPECT_LT(At(tracks, 1, 22)->confidence, kMeasuredConfidence);
}

TEST(CorrectTest, AddMakesAnAnimal) {
  const Tracks tracks = Corrected("add 3 50 60\npin 5 5 70 60\n");
  ASSERT_NE(Find(tracks, 5), nullptr);
  EXPECT_EQ(Find(tracks, 5)->detections.size(), 3u);
  EXPECT_EQ(At(tracks, 5, 3)->box.width, 8);
  EXPECT_EQ(At(tracks, 5, 4)->box.Center(), (Vec2d{60, 60}));
}

TEST(CorrectTest, OperationsFollowOneAnother) {
  const Tracks tracks = Corrected("# a comment\nsplit 1 15\njoin 1 5\n");
  EXPECT_EQ(Find(tracks, 1)->detections.size(), 20u);
  EXPECT_EQ(Find(tracks, 5), nullptr);
}

class CorrectRefuses : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(CorrectRefuses, WithTheLine) {
  const auto [line, fault] = GetParam();
  try {
    Corrected(std::string("# first\n") + line + "\n");
    FAIL() << line;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("c.txt:2: "));
    EXPECT_THAT(error.what(), testing::HasSubstr(fault));
  }
}

INSTANTIATE_TEST_SUITE_P(Faults, CorrectRefuses,
                         testing::Values(std::pair{"swap 1 9 5", "no track 9"},
                                         std::pair{"swap 1 2 31", "no frame 31"},
                                         std::pair{"split 3 5", "no track 3"},
                                         std::pair{"split 1 21", "cannot be split"},
                                         std::pair{"join 1 2", "both seen in frame 5"},
                                         std::pair{"delete 7", "no track 7"},
                                         std::pair{"delete 1 22 24", "no row in frames"},
                                         std::pair{"pin 1 99 5 5", "no frame 99"},
                                         std::pair{"add 99 5 5", "no frame 99"}));

}  // namespace
}  // namespace flocklift
