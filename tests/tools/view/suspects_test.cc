// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/suspects.h"

#include <gtest/gtest.h>

#include <functional>
#include <sstream>
#include <string>
#include <utility>

namespace flocklift {
namespace {

constexpr double kWidth = 1000, kHeight = 800;

Tracklet Along(Id id, int first, int last, const std::function<Vec2d(int)>& at) {
  Tracklet t{id, {}};
  for (int f = first; f <= last; ++f) {
    Detection d;
    d.frame = f;
    d.box = Box::Around(at(f), 12, 8);
    t.detections.push_back(d);
  }
  return t;
}

std::vector<Suspect> Find(std::vector<Tracklet> tracklets) {
  Tracks tracks;
  tracks.tracklets = std::move(tracklets);
  return FindSuspects(Shared(std::move(tracks)), kWidth, kHeight);
}

TEST(Suspects, SmoothTracksThatKeepApartAreFine) {
  EXPECT_TRUE(Find({Along(1, 1, 60,
                          [](int f) {
                            return Vec2d{100 + 5.0 * f, 200};
                          }),
                    Along(2, 1, 60,
                          [](int f) {
                            return Vec2d{100 + 5.0 * f, 300 + 0.02 * f * f};
                          })})
                  .empty());
}

TEST(Suspects, AnExchangeOfIdentitiesIsTheWorst) {
  // Two cross in frame 30 as straight lines; as tracks they bounce off each other.
  const auto up = [](int f) { return Vec2d{100 + 5.0 * f, 250 + 3.0 * (f - 30)}; };
  const auto down = [](int f) { return Vec2d{102 + 5.0 * f, 250 - 3.0 * (f - 30)}; };
  const auto found = Find({Along(1, 1, 60, [&](int f) { return f < 30 ? up(f) : down(f); }),
                           Along(2, 1, 60, [&](int f) { return f < 30 ? down(f) : up(f); }),
                           Along(3, 1, 40, [](int f) {
                             return Vec2d{100 + 5.0 * f, 700};
                           })});
  ASSERT_GE(found.size(), 2u);
  EXPECT_EQ(found[0].what, "meeting");
  EXPECT_EQ(found[0].id, 1);
  EXPECT_EQ(found[0].other_id, 2);
  EXPECT_NEAR(found[0].frame, 30, 3);
  EXPECT_GT(found[0].doubt, 0.8);
  // Those who really cross are less in doubt.
  const auto crossed = Find({Along(1, 1, 60, up), Along(2, 1, 60, down)});
  ASSERT_EQ(crossed.size(), 1u);
  EXPECT_LT(crossed[0].doubt, found[0].doubt);
}

TEST(Suspects, AJumpStandsOut) {
  const auto wobble = [](int f) { return 0.1 * ((f * 7919) % 13 - 6) / 6; };
  const auto found =
      Find({Along(1, 1, 60,
                  [&](int f) {
                    return Vec2d{100 + 5.0 * f + (f >= 40 ? 30 : 0), 200 + wobble(f)};
                  }),
            Along(2, 1, 60, [&](int f) {
              return Vec2d{100 + 5.0 * f, 400 + wobble(f + 3)};
            })});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].what, "jump");
  EXPECT_EQ(found[0].id, 1);
  EXPECT_NEAR(found[0].frame, 40, 1);
  EXPECT_GT(found[0].doubt, 0.5);
}

TEST(Suspects, LongGapsAreInMoreDoubtThanShortOnes) {
  Tracklet t = Along(1, 1, 90, [](int f) { return Vec2d{100 + 5.0 * f, 200}; });
  for (int f = 20; f <= 22; ++f) t.detections[static_cast<std::size_t>(f - 1)].confidence = 0.4;
  for (int f = 60; f <= 75; ++f) t.detections[static_cast<std::size_t>(f - 1)].confidence = 0.4;
  const auto found = Find({t});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].what, "gap");
  EXPECT_NEAR(found[0].frame, 67, 1);
  EXPECT_EQ(found[1].frame, 21);
  EXPECT_GT(found[0].doubt, found[1].doubt);
}

TEST(Suspects, BirthsAndDeathsInTheMiddleOfThePicture) {
  const auto found = Find({Along(1, 1, 60,
                                 [](int f) {
                                   return Vec2d{100 + 5.0 * f, 200};
                                 }),
                           Along(2, 20, 60,
                                 [](int f) {
                                   return Vec2d{500 + 2.0 * f, 400};
                                 }),
                           Along(3, 30, 60,
                                 [](int f) {
                                   return Vec2d{7.0 * (f - 29), 600};
                                 }),
                           Along(4, 1, 50, [](int f) {
                             return Vec2d{500 + 2.0 * f, 500};
                           })});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].what, "start");
  EXPECT_EQ(found[0].id, 2);
  EXPECT_EQ(found[1].what, "end");
  EXPECT_EQ(found[1].id, 4);
  EXPECT_EQ(found[1].frame, 50);
}

std::vector<Correction> Corrections(const std::string& lines) {
  std::istringstream stream(lines);
  return ReadCorrections(stream, "lines");
}

const nlohmann::ordered_json& Doubts() {
  static const auto kDoubts = nlohmann::ordered_json::parse(R"([
    {"frame": 100, "last_frame": 104, "kind": "swap", "ids": [3, 7], "chance": 0.5},
    {"frame": 300, "last_frame": 300, "kind": "jump", "ids": [7], "chance": 0.4},
    {"frame": 310, "kind": "from another version"},
    {"frame": 400, "last_frame": 420, "kind": "merge", "ids": [7, 9], "chance": 0.3}])");
  return kDoubts;
}

std::string TextOf(const std::vector<Suspect>& suspects) {
  std::string text;
  for (const Suspect& s : suspects) {
    text += s.what + ' ' + std::to_string(s.id) + ' ' + std::to_string(s.other_id) + ' ' +
            std::to_string(s.frame) + "; ";
  }
  return text;
}

TEST(SuspectsOfTracker, AreItsListInItsOrder) {
  const auto all = SuspectsOfTracker(Doubts(), {});
  EXPECT_EQ(TextOf(all), "swap 3 7 100; jump 7 0 300; merge 7 9 400; ");
  EXPECT_EQ(all[0].doubt, 0.5);
  EXPECT_TRUE(SuspectsOfTracker(nlohmann::ordered_json::array(), {}).empty());
}

TEST(SuspectsOfTracker, LeaveOutWhatWasDealtWith) {
  const auto after = [](const std::string& lines) {
    return TextOf(SuspectsOfTracker(Doubts(), Corrections(lines)));
  };
  // After the swap, what was 7 is called 3.
  EXPECT_EQ(after("swap 7 3 102\n"), "jump 3 0 300; merge 3 9 400; ");
  EXPECT_EQ(after("swap 7 3 350\n"), "swap 3 7 100; jump 7 0 300; merge 3 9 400; ");
  EXPECT_EQ(after("swap 1 3 102\n"), "swap 3 7 100; jump 7 0 300; merge 7 9 400; ");
  EXPECT_EQ(after("delete 7\n"), "");
  EXPECT_EQ(after("delete 7 290 310\n"), "swap 3 7 100; merge 7 9 400; ");
  EXPECT_EQ(after("split 7 305\n"), "swap 3 7 100; merge 7 9 400; ");
  EXPECT_EQ(after("pin 9 430 10 20\n"), "swap 3 7 100; jump 7 0 300; ");
  EXPECT_EQ(after("join 9 7\n"), "swap 3 9 100; jump 9 0 300; ");
  EXPECT_EQ(after("add 300 1 2\n"), "swap 3 7 100; jump 7 0 300; merge 7 9 400; ");
}

TEST(Suspects, CanBeEndedInTheMiddle) {
  struct Ended {};
  Tracks tracks;
  tracks.tracklets = {Along(1, 1, 60, [](int f) { return Vec2d{5.0 * f, 200}; })};
  EXPECT_THROW(FindSuspects(Shared(std::move(tracks)), kWidth, kHeight,
                            [](std::int64_t done, std::int64_t) {
                              if (done == 30) throw Ended();
                            }),
               Ended);
}

}  // namespace
}  // namespace flocklift
