// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/tracker.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "simulate/core/check.h"
#include "tests/track/pictures.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 480, kHeight = 320, kFrames = 40, kAnimals = 8;

// Gentle arcs, all inside the picture.
Vec2d TruePosition(int animal, int frame) {
  const double phase = animal * 0.8 + 0.03 * frame;
  return {60 + 50.0 * (animal % 4) + 3.0 * frame + 8 * std::sin(phase),
          80 + 90.0 * (animal / 4) + 1.5 * frame + 8 * std::cos(phase)};
}

std::vector<SoftBlob> Animals(int frame) {
  std::vector<SoftBlob> blobs;
  for (int k = 0; k < kAnimals; ++k) {
    blobs.push_back({.center = TruePosition(k, frame), .contrast = -90});
  }
  return blobs;
}

class TrackerTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::path(testing::TempDir()) / "tracker_test_pictures";
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    const Sky sky{.level = 150, .gradient_x = 0.05, .gradient_y = 0.05, .noise = 3};
    for (int frame = 1; frame <= kFrames; ++frame) {
      const GrayImage picture =
          DrawPicture(kWidth, kHeight, sky, Animals(frame), static_cast<std::uint64_t>(frame));
      const cv::Mat view(kHeight, kWidth, CV_8UC1,
                         const_cast<std::uint8_t*>(picture.pixels.data()));
      cv::imwrite((folder_ / (std::to_string(frame) + ".png")).string(), view);
    }
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static void ExpectTruth(const Tracks& tracks) {
    ASSERT_EQ(tracks.tracklets.size(), static_cast<std::size_t>(kAnimals));
    std::vector<int> found(kAnimals, 0);
    for (const Tracklet& tracklet : tracks.tracklets) {
      EXPECT_EQ(tracklet.detections.size(), static_cast<std::size_t>(kFrames));
      int who = -1;
      for (int k = 0; k < kAnimals; ++k) {
        const Vec2d p = TruePosition(k, 1), q = tracklet.detections[0].box.Center();
        if (std::hypot(p.x - q.x, p.y - q.y) < 1) who = k;
      }
      ASSERT_GE(who, 0);
      ++found[who];
      for (const Detection& d : tracklet.detections) {
        const Vec2d p = TruePosition(who, d.frame), q = d.box.Center();
        EXPECT_LT(std::hypot(p.x - q.x, p.y - q.y), 0.5);
        EXPECT_GE(d.confidence, kMeasuredConfidence);
      }
    }
    EXPECT_EQ(found, std::vector<int>(kAnimals, 1));
  }

  static fs::path folder_;
};

fs::path TrackerTest::folder_;

TEST_F(TrackerTest, FollowsThePicturesOfAFolder) {
  std::int64_t last_done = 0, total = 0;
  const TrackerResult result = TrackVideo(
      {}, folder_,
      [&](std::int64_t done, std::int64_t all) {
        EXPECT_EQ(done, last_done + 1);
        last_done = done;
        total = all;
      },
      25.0);
  ExpectTruth(result.tracks);
  EXPECT_EQ(last_done, kFrames);
  EXPECT_EQ(total, kFrames);
  EXPECT_EQ(result.tracks.fps, 25.0);
  EXPECT_EQ(result.report.frames, kFrames);
  EXPECT_EQ(result.report.detections, kFrames * kAnimals);
  EXPECT_EQ(result.report.rows, kFrames * kAnimals);
  EXPECT_TRUE(result.report.dark);
  EXPECT_FALSE(result.report.bright);
  for (const Detection& d : result.tracks.tracklets[0].detections) {
    ASSERT_TRUE(d.shape.has_value());
    EXPECT_NEAR(d.shape->major, 8, 2);
  }
}

TEST_F(TrackerTest, SameFootageSameTracks) {
  const Tracks one = TrackVideo({}, folder_).tracks, two = TrackVideo({}, folder_).tracks;
  ASSERT_EQ(one.tracklets.size(), two.tracklets.size());
  for (std::size_t k = 0; k < one.tracklets.size(); ++k) {
    for (std::size_t t = 0; t < one.tracklets[k].detections.size(); ++t) {
      const Box &a = one.tracklets[k].detections[t].box, &b = two.tracklets[k].detections[t].box;
      EXPECT_EQ(a.left, b.left);
      EXPECT_EQ(a.top, b.top);
    }
  }
}

TEST_F(TrackerTest, LinksDetectionsOfOthers) {
  std::vector<DetectionFrame> frames;
  for (int frame = 1; frame <= kFrames; ++frame) {
    DetectionFrame f{frame, {}};
    for (const SoftBlob& b : Animals(frame)) {
      Detection d;
      d.frame = frame;
      d.box = Box::Around(b.center, 9, 7);
      f.detections.push_back(d);
    }
    frames.push_back(f);
  }
  ExpectTruth(TrackDetections({}, frames, kWidth, kHeight).tracks);
  std::swap(frames[3], frames[4]);
  EXPECT_THROW(TrackDetections({}, frames, kWidth, kHeight), std::invalid_argument);
}

// Ten seconds in one place: a lamp, not an animal.
TEST_F(TrackerTest, WhatStandsStillIsNoAnimal) {
  std::vector<DetectionFrame> frames;
  for (int frame = 1; frame <= kFrames; ++frame) {
    Detection lamp;
    lamp.frame = frame;
    lamp.box = Box::Around({400, 300}, 12, 12);
    frames.push_back({frame, {lamp}});
  }
  const TrackerResult result = TrackDetections({}, frames, kWidth, kHeight);
  EXPECT_TRUE(result.tracks.tracklets.empty());
  EXPECT_EQ(result.report.still_tracks, 1);
  EXPECT_EQ(TrackDetections({.min_travel = 0}, frames, kWidth, kHeight).tracks.tracklets.size(),
            1u);
}

// Nothing to learn from at the start: the motion noise is learned when there is.
TEST_F(TrackerTest, LateArrivalsTeachTheirMotion) {
  std::vector<DetectionFrame> frames;
  std::vector<Vec2d> p, v;
  Rng rng(8);
  for (int k = 0; k < 12; ++k) {
    p.push_back({60.0 + 110 * (k % 4), 60.0 + 100 * (k / 4)});
    v.push_back({rng.Uniform(-1, 1), rng.Uniform(-1, 1)});
  }
  for (int frame = 1; frame <= 320; ++frame) {
    DetectionFrame f{frame, {}};
    for (std::size_t k = 0; frame > 150 && k < p.size(); ++k) {
      v[k].x = 0.9 * v[k].x + 1.2 * rng.Normal() - 0.01 * (p[k].x - 60.0 - 110 * (k % 4));
      v[k].y = 0.9 * v[k].y + 1.2 * rng.Normal() - 0.01 * (p[k].y - 60.0 - 100 * (k / 4));
      p[k] = {p[k].x + v[k].x, p[k].y + v[k].y};
      Detection d;
      d.frame = frame;
      d.box = Box::Around(p[k], 6, 6);
      f.detections.push_back(d);
    }
    frames.push_back(f);
  }
  const MotionNoise learned = TrackDetections({}, frames, kWidth, kHeight).report.noise;
  const double size = std::sqrt(0.785 * 36);
  EXPECT_GT(std::sqrt(learned.ProcessVariance(size)), 0.6);
  EXPECT_LT(std::sqrt(learned.ProcessVariance(size)), 2.4);
}

// At the edge of the picture the box is cut off; the centre is reckoned from the usual size, and
// rows end where it leaves the picture.
TEST_F(TrackerTest, CentresAtTheEdgeAreCompleted) {
  const fs::path folder = fs::path(testing::TempDir()) / "tracker_test_edge";
  fs::create_directories(folder);
  const auto truth = [](int frame) { return Vec2d{70 - 2.0 * frame, 160 + 0.2 * frame}; };
  for (int frame = 1; frame <= 45; ++frame) {
    const GrayImage picture =
        DrawPicture(kWidth, kHeight, {.level = 150, .noise = 2},
                    {{.center = truth(frame), .contrast = -90, .major_sd = 3.5, .minor_sd = 2}},
                    static_cast<std::uint64_t>(frame));
    const cv::Mat view(kHeight, kWidth, CV_8UC1, const_cast<std::uint8_t*>(picture.pixels.data()));
    cv::imwrite((folder / (std::to_string(frame) + ".png")).string(), view);
  }
  const TrackerResult result = TrackVideo({}, folder);
  fs::remove_all(folder);
  ASSERT_EQ(result.tracks.tracklets.size(), 1u);
  for (const Detection& d : result.tracks.tracklets[0].detections) {
    EXPECT_NEAR(d.box.Center().x, truth(d.frame).x, 1.5) << d.frame;
    EXPECT_GE(d.box.Center().x, -0.5);
  }
  const int last = result.tracks.tracklets[0].detections.back().frame;
  EXPECT_GE(last, 33);
  EXPECT_LE(last, 36);  // the centre crosses the edge after frame 35
}

TEST_F(TrackerTest, GapsAreFilledAndMarked) {
  std::vector<DetectionFrame> frames;
  for (int frame = 1; frame <= 30; ++frame) {
    DetectionFrame f{frame, {}};
    Detection d;
    d.frame = frame;
    d.box = Box::Around({20 + 5.0 * frame, 50}, 8, 8);
    if (frame <= 12 || frame > 16) f.detections.push_back(d);
    frames.push_back(f);
  }
  const TrackerResult result = TrackDetections({}, frames, kWidth, kHeight);
  ASSERT_EQ(result.tracks.tracklets.size(), 1u);
  const auto& rows = result.tracks.tracklets[0].detections;
  ASSERT_EQ(rows.size(), 30u);
  EXPECT_EQ(result.report.filled_rows, 4);
  for (const Detection& d : rows) {
    EXPECT_EQ(d.confidence<kMeasuredConfidence, d.frame> 12 && d.frame <= 16);
    EXPECT_EQ(d.shape.has_value(), d.confidence >= kMeasuredConfidence);
    EXPECT_NEAR(d.box.Center().x, 20 + 5.0 * d.frame, 0.1);
  }
}

TEST_F(TrackerTest, EmptySkyHasNoTracks) {
  const fs::path folder = fs::path(testing::TempDir()) / "tracker_test_empty_sky";
  fs::create_directories(folder);
  for (int frame = 1; frame <= 3; ++frame) {
    cv::imwrite((folder / (std::to_string(frame) + ".png")).string(),
                cv::Mat(64, 64, CV_8UC1, cv::Scalar(120)));
  }
  const TrackerResult result = TrackVideo({}, folder);
  fs::remove_all(folder);
  EXPECT_TRUE(result.tracks.tracklets.empty());
  EXPECT_EQ(result.report.frames, 3);
}

TEST_F(TrackerTest, ABrokenPictureInTheMiddleIsToldByName) {
  const fs::path folder = fs::path(testing::TempDir()) / "tracker_test_broken";
  fs::create_directories(folder);
  for (int frame = 1; frame <= 5; ++frame) {
    cv::imwrite((folder / (std::to_string(frame) + ".png")).string(),
                cv::Mat(64, frame == 4 ? 32 : 64, CV_8UC1, cv::Scalar(120)));
  }
  EXPECT_THROW(TrackVideo({}, folder), InputError);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace flocklift
