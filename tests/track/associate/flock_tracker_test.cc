// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/flock_tracker.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>

#include "tests/track/pictures.h"

namespace flocklift {
namespace {

constexpr double kWidth = 640, kHeight = 480;
const MotionNoise kNoise{.acceleration = 0.03, .measurement = 0.05, .speed_sd = 5};

std::vector<TrackRecord> Track(const std::vector<BlobFrame>& frames,
                               const AssociationOptions& options = {}) {
  FlockTracker tracker(options, kNoise, kWidth, kHeight);
  for (const BlobFrame& frame : frames) tracker.Step(frame);
  return tracker.Finish();
}

// Frames 1 .. count of animals whose centres are given by frame; NaN: not seen.
std::vector<BlobFrame> Film(int count, const std::vector<std::function<Vec2d(int)>>& paths,
                            double noise = 0.1) {
  std::vector<BlobFrame> frames;
  for (int frame = 1; frame <= count; ++frame) {
    std::vector<SoftBlob> blobs;
    for (std::size_t k = 0; k < paths.size(); ++k) {
      Rng rng(11, k, static_cast<std::uint32_t>(frame));
      Vec2d p = paths[k](frame);
      if (std::isnan(p.x)) continue;
      p.x += noise * rng.Normal();
      p.y += noise * rng.Normal();
      blobs.push_back({.center = p});
    }
    frames.push_back(BlobsOf(frame, blobs));
  }
  return frames;
}

constexpr Vec2d kNowhere{std::numeric_limits<double>::quiet_NaN(), 0};

double Distance(const Vec2d& a, const Vec2d& b) { return std::hypot(a.x - b.x, a.y - b.y); }

void ExpectSame(const std::vector<TrackPoint>& a, const std::vector<TrackPoint>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t t = 0; t < a.size(); ++t) {
    EXPECT_EQ(a[t].frame, b[t].frame);
    EXPECT_EQ(a[t].position, b[t].position);
    EXPECT_EQ(a[t].shared, b[t].shared);
  }
}

TEST(FlockTrackerTest, FollowsOneFromItsFirstFrame) {
  const auto path = [](int t) { return Vec2d{50 + 4.0 * t, 100 + 1.5 * t}; };
  const auto tracks = Track(Film(40, {path}));
  ASSERT_EQ(tracks.size(), 1u);
  ASSERT_EQ(tracks[0].sightings.size(), 40u);
  EXPECT_EQ(tracks[0].sightings.first_frame(), 1);
  EXPECT_EQ(tracks[0].sightings.last_frame(), 40);
}

TEST(FlockTrackerTest, CrossingAnimalsKeepTheirIdentity) {
  const auto a = [](int t) { return Vec2d{100 + 5.0 * t, 200 + 2.0 * t}; };
  const auto b = [](int t) { return Vec2d{100 + 5.0 * t, 300 - 2.0 * t}; };  // meet at t = 25
  std::vector<BlobFrame> frames = Film(50, {a, b});
  for (BlobFrame& frame : frames) {
    // Nearer than 5 px they are one blob.
    if (Distance(a(frame.frame), b(frame.frame)) < 5) frame.blobs = {Merged(frame)};
  }
  const auto tracks = Track(frames);
  ASSERT_EQ(tracks.size(), 2u);
  for (const TrackRecord& track : tracks) {
    const bool is_a = Distance(track.sightings.First(1).front().position, a(1)) < 2;
    EXPECT_EQ(track.sightings.size(), 50u);
    for (const TrackPoint& s : track.sightings.All()) {
      EXPECT_LT(Distance(s.position, is_a ? a(s.frame) : b(s.frame)), 3.0) << s.frame;
    }
  }
}

TEST(FlockTrackerTest, MergedBlobIsSharedForAsLongAsItLasts) {
  const auto a = [](int t) {
    return Vec2d{100 + 4.0 * t, 200 + std::max(0.0, 12.0 - t) + std::max(0.0, t - 32.0)};
  };
  const auto b = [](int t) { return Vec2d{104 + 4.0 * t, 198.0}; };
  std::vector<BlobFrame> frames = Film(45, {a, b});
  for (BlobFrame& frame : frames) {
    if (frame.frame >= 10 && frame.frame <= 34) frame.blobs = {Merged(frame)};
  }
  const auto tracks = Track(frames);
  ASSERT_EQ(tracks.size(), 2u);
  for (const TrackRecord& track : tracks) {
    EXPECT_GE(track.sightings.size(), 43u);
    int shared = 0;
    for (const TrackPoint& s : track.sightings.All()) shared += s.shared ? 1 : 0;
    EXPECT_GE(shared, 20);
  }
}

// A second track on one animal (it was lost for a moment and found as a new one) must not ride
// along in the same blob for ever.
TEST(FlockTrackerTest, OneAnimalHasOneTrack) {
  // It jumps at frame 20: a new track begins, the old one is still predicted nearby.
  const auto path = [](int t) {
    return t < 20 ? Vec2d{100 + 3.0 * t, 200} : Vec2d{100 + 3.0 * t, 212};
  };
  const auto far = [](int t) { return Vec2d{500 - 2.0 * t, 400}; };
  int rows = 0;
  for (const TrackRecord& track : Track(Film(80, {path, far}))) {
    rows += static_cast<int>(track.sightings.size());
  }
  EXPECT_LE(rows, 2 * 80 + 8);
  EXPECT_GE(rows, 2 * 80 - 8);
}

// Its wings pull the blob of one animal to and fro, more than its motion announces: other tracks
// begin on the blob, and take it by turns with the first. They were never seen apart from it, so
// they do not live on beside it as its neighbours.
TEST(FlockTrackerTest, WhatWasNeverSeenApartSharesNothing) {
  const auto path = [](int t) {
    Rng rng(3, static_cast<std::uint64_t>(t));
    const double pull = t < 30 ? 0 : t / 3 % 2 == 0 ? 1.5 : -1.5;
    return Vec2d{50 + 3.0 * t, 100 + pull + 0.3 * rng.Normal()};
  };
  std::size_t rows = 0;
  for (const TrackRecord& track : Track(Film(120, {path}))) rows += track.sightings.size();
  EXPECT_GE(rows, 110u);
  EXPECT_LE(rows, 145u);
}

TEST(FlockTrackerTest, CoastsThroughAShortGap) {
  const auto path = [](int t) {
    return t > 15 && t <= 21 ? kNowhere : Vec2d{50 + 4.0 * t, 100 + 1.5 * t};
  };
  const auto tracks = Track(Film(40, {path}));
  ASSERT_EQ(tracks.size(), 1u);
  EXPECT_EQ(tracks[0].sightings.size(), 34u);
}

TEST(FlockTrackerTest, GivesUpAfterALongGap) {
  const auto path = [](int t) {
    return t > 15 && t <= 35 ? kNowhere : Vec2d{50 + 4.0 * t, 100 + 1.5 * t};
  };
  EXPECT_EQ(Track(Film(60, {path}), {.max_missed_frames = 10}).size(), 2u);
  EXPECT_EQ(Track(Film(60, {path}), {.max_missed_frames = 25}).size(), 1u);
}

TEST(FlockTrackerTest, BirthsAndDeathsAtAnyTime) {
  const auto a = [](int t) { return t <= 20 ? Vec2d{50 + 4.0 * t, 100} : kNowhere; };
  const auto b = [](int t) { return t >= 30 ? Vec2d{600 - 4.0 * t, 300} : kNowhere; };
  const auto tracks = Track(Film(60, {a, b}));
  ASSERT_EQ(tracks.size(), 2u);
  EXPECT_EQ(tracks[0].sightings.last_frame(), 20);
  EXPECT_EQ(tracks[1].sightings.first_frame(), 30);
  EXPECT_EQ(tracks[1].sightings.last_frame(), 60);
}

TEST(FlockTrackerTest, FlickersAreNoTracks) {
  std::vector<BlobFrame> frames;
  for (int frame = 1; frame <= 60; ++frame) {
    Rng rng(5, static_cast<std::uint64_t>(frame));
    frames.push_back(BlobsOf(frame, {{.center = {rng.Uniform(20, 620), rng.Uniform(20, 460)}}}));
  }
  EXPECT_TRUE(Track(frames).empty());
}

// Sixty animals in every direction, one in twenty unseen at random.
TEST(FlockTrackerTest, FollowsACrowd) {
  constexpr int kCount = 60;
  std::vector<std::function<Vec2d(int)>> paths;
  for (std::uint64_t k = 0; k < kCount; ++k) {
    Rng rng(21, k);
    const Vec2d start{rng.Uniform(150, 490), rng.Uniform(130, 350)};
    const Vec2d velocity{rng.Uniform(-3, 3), rng.Uniform(-2, 2)};
    paths.push_back([=](int t) {
      Rng miss(22, k, static_cast<std::uint32_t>(t));
      return miss.Uniform() < 0.05 ? kNowhere
                                   : Vec2d{start.x + velocity.x * t, start.y + velocity.y * t};
    });
  }
  const auto tracks = Track(Film(40, paths));
  int pure = 0;
  for (const TrackRecord& track : tracks) {
    if (track.sightings.size() < 30) continue;
    for (const auto& path : paths) {
      int near = 0;
      for (const TrackPoint& s : track.sightings.All()) {
        near += Distance(s.position, path(s.frame)) < 1 ? 1 : 0;
      }
      if (near == static_cast<int>(track.sightings.size())) {
        ++pure;
        break;
      }
    }
  }
  EXPECT_GE(pure, kCount - 4);
}

TEST(FlockTrackerTest, SameInputSameTracks) {
  const auto frames = Film(40, {[](int t) {
                                  return Vec2d{50 + 4.0 * t, 100 + 1.5 * t};
                                },
                                [](int t) {
                                  return Vec2d{300 - 3.0 * t, 110 + 1.0 * t};
                                }});
  const auto one = Track(frames), two = Track(frames);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    ExpectSame(one[k].sightings.All(), two[k].sightings.All());
  }
}

// Animals that end, begin, and share a blob, for longer than memory holds their sightings: the
// state is saved twice and restored once, as that of another run.
TEST(FlockTrackerTest, GoesOnFromASavedStateAndAFile) {
  constexpr int kFrames = 420, kSaved = 310;
  const auto a = [](int t) { return t > 30 ? kNowhere : Vec2d{100 + 5.0 * t, 200 + 2.0 * t}; };
  const auto b = [](int t) {
    return Vec2d{320 + 200 * std::sin(0.03 * t), 240 + 100 * std::cos(0.03 * t)};
  };
  const auto c = [](int t) {
    return t < 25 ? kNowhere
                  : Vec2d{320 + 200 * std::sin(0.02 * t), 240 - 100 * std::cos(0.02 * t)};
  };
  const std::vector<BlobFrame> frames = Film(kFrames, {a, b, c});
  const auto folder = std::filesystem::path(testing::TempDir()) / "flock_tracker_test";
  std::filesystem::remove_all(folder);
  FlockTracker whole({}, kNoise, kWidth, kHeight);
  std::string state;
  {
    SightingFile file(folder / "sightings");
    FlockTracker first({}, kNoise, kWidth, kHeight, &file);
    for (const BlobFrame& frame : frames) {
      whole.Step(frame);
      if (frame.frame > kSaved + 40) continue;
      first.Step(frame);
      if (frame.frame != 20 && frame.frame != kSaved) continue;
      StateWriter out;
      first.Save(&out);
      state = out.bytes();
    }
    EXPECT_GT(file.size(), 2 * 200 * sizeof(TrackPoint));
  }
  SightingFile file(folder / "sightings");
  FlockTracker second({}, MotionNoise{}, kWidth, kHeight, &file);
  StateReader in(state);
  second.Load(&in);
  EXPECT_TRUE(in.AtEnd());
  for (const BlobFrame& frame : frames) {
    if (frame.frame > kSaved) second.Step(frame);
  }
  const auto wanted = whole.Finish(), is = second.Finish();
  ASSERT_EQ(is.size(), wanted.size());
  ASSERT_GE(is.size(), 3u);
  for (std::size_t k = 0; k < is.size(); ++k) {
    EXPECT_EQ(is[k].size, wanted[k].size);
    EXPECT_EQ(is[k].mass, wanted[k].mass);
    ExpectSame(is[k].sightings.All(), wanted[k].sightings.All());
  }
  SightingFile none(folder / "none");
  FlockTracker third({}, MotionNoise{}, kWidth, kHeight, &none);
  StateReader again(state);
  EXPECT_THROW(third.Load(&again), std::runtime_error);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace flocklift
