// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/track_checkpoint.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>

#include "tests/track/pictures.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 240, kHeight = 160, kFrames = 130, kKilledAt = 115;

// Six animals that cross, of which one goes and another comes, before a few rocks; the camera
// shakes.
std::vector<SoftBlob> Scene(int frame) {
  const double shake_x = 1.5 * std::sin(1.1 * frame), shake_y = std::cos(0.9 * frame);
  std::vector<SoftBlob> blobs;
  for (int k = 0; k < 6; ++k) {
    if ((k == 1 && frame > 80) || (k == 2 && frame < 95)) continue;
    const double phase = k + 0.035 * frame;
    blobs.push_back({.center = {120 + shake_x + (60 + 8 * k) * std::sin(phase),
                                70 + shake_y + (30 + 4 * k) * std::cos(1.3 * phase + k)},
                     .contrast = -90});
  }
  Rng rng(5);
  for (int k = 0; k < 60; ++k) {
    blobs.push_back({.center = {rng.Uniform(0, kWidth) + shake_x, rng.Uniform(125, 160) + shake_y},
                     .contrast = rng.Uniform(20, 60),
                     .major_sd = 3,
                     .minor_sd = 3});
  }
  return blobs;
}

class TrackCheckpointTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::path(testing::TempDir()) / "track_checkpoint_test";
    fs::remove_all(folder_);
    fs::create_directories(Footage());
    for (int frame = 1; frame <= kFrames; ++frame) {
      const GrayImage picture = DrawPicture(kWidth, kHeight, {.level = 160, .noise = 2},
                                            Scene(frame), static_cast<std::uint64_t>(frame));
      const cv::Mat view(kHeight, kWidth, CV_8UC1,
                         const_cast<std::uint8_t*>(picture.pixels.data()));
      cv::imwrite((Footage() / (std::to_string(frame) + ".png")).string(), view);
    }
    whole_ = TrackVideo(Options(), Footage()).tracks;
    // Stops in the middle, as if killed.
    const auto stop = [](std::int64_t done, std::int64_t) {
      if (done == kKilledAt) throw std::runtime_error("killed");
    };
    EXPECT_THROW(TrackVideo(Options(), Footage(), stop, {}, Place()), std::runtime_error);
    fs::rename(Place().folder, folder_ / "killed");
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static fs::path Footage() { return folder_ / "footage"; }
  static CheckpointPlace Place() { return {folder_ / "checkpoint", std::chrono::seconds(0)}; }
  static TrackerOptions Options() { return {.camera = {.camera = "moves"}}; }

  void SetUp() override { fs::copy(folder_ / "killed", Place().folder); }
  void TearDown() override { fs::remove_all(Place().folder); }

  // Where a run begins.
  static std::int64_t FirstFrame(const TrackerOptions& options) {
    std::int64_t first = 0;
    const auto stop = [&first](std::int64_t done, std::int64_t) {
      first = done;
      throw std::runtime_error("killed");
    };
    EXPECT_THROW(TrackVideo(options, Footage(), stop, {}, Place()), std::runtime_error);
    return first;
  }

  static void ExpectSameWhenResumed() {
    EXPECT_GT(FirstFrame(Options()), 50);  // it did go on
    ExpectSame(whole_, TrackVideo(Options(), Footage(), {}, {}, Place()).tracks);
    EXPECT_FALSE(fs::exists(Place().folder));
  }

  static void ExpectSame(const Tracks& a, const Tracks& b) {
    ASSERT_EQ(a.tracklets.size(), b.tracklets.size());
    ASSERT_GE(a.tracklets.size(), 6u);
    for (std::size_t k = 0; k < a.tracklets.size(); ++k) {
      const auto &p = a.tracklets[k].detections, &q = b.tracklets[k].detections;
      ASSERT_EQ(p.size(), q.size());
      for (std::size_t t = 0; t < p.size(); ++t) {
        EXPECT_EQ(p[t].frame, q[t].frame);
        EXPECT_EQ(p[t].box.left, q[t].box.left);
        EXPECT_EQ(p[t].box.top, q[t].box.top);
        EXPECT_EQ(p[t].box.width, q[t].box.width);
        EXPECT_EQ(p[t].confidence, q[t].confidence);
        EXPECT_EQ(p[t].shape.has_value(), q[t].shape.has_value());
      }
    }
  }

  static fs::path folder_;
  static Tracks whole_;
};

fs::path TrackCheckpointTest::folder_;
Tracks TrackCheckpointTest::whole_;

TEST_F(TrackCheckpointTest, AKilledRunGoesOnAndEndsWithTheSameTracks) { ExpectSameWhenResumed(); }

TEST_F(TrackCheckpointTest, SightingsAfterTheStateAreCutOff) {
  std::ofstream(Place().folder / "sightings", std::ios::binary | std::ios::app) << "half a piece";
  ExpectSameWhenResumed();
}

TEST_F(TrackCheckpointTest, OfOtherOptionsItIsIgnored) {
  TrackerOptions other = Options();
  other.detect.threshold = 8;
  EXPECT_EQ(FirstFrame(other), 1);
}

TEST_F(TrackCheckpointTest, WithoutAllSightingsItIsIgnored) {
  fs::resize_file(Place().folder / "sightings", 10);
  EXPECT_EQ(FirstFrame(Options()), 1);
}

TEST_F(TrackCheckpointTest, OfFootageThatChangedItIsIgnored) {
  const fs::path picture = Footage() / "7.png";
  const auto before = fs::last_write_time(picture);
  fs::last_write_time(picture, before + std::chrono::seconds(3));
  EXPECT_EQ(FirstFrame(Options()), 1);
  fs::last_write_time(picture, before);
}

TEST_F(TrackCheckpointTest, WithoutAFolderNothingIsKept) {
  internal::TrackCheckpoint none({}, "");
  EXPECT_FALSE(none.Load());
  EXPECT_FALSE(none.IsDue());
  none.Remove();
}

}  // namespace
}  // namespace flocklift
