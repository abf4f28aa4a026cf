// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Footage with a lamp post and a tree whose leaves sway, before which birds fly.

#include "track/finder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>

#include "tests/track/pictures.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 320, kHeight = 200, kFrames = 170, kBirds = 6, kLeaves = 60;

// To and fro above the tree, past the post.
Vec2d Bird(int k, int frame) {
  return {160 + 130 * std::sin(0.021 * frame + k), 20.0 + 15 * k + 8 * std::cos(0.033 * frame + k)};
}

std::vector<SoftBlob> Scene(int frame) {
  std::vector<SoftBlob> blobs;
  for (int k = 0; k < kBirds; ++k) blobs.push_back({.center = Bird(k, frame), .contrast = -90});
  for (int y = 60; y < kHeight; y += 2) {
    blobs.push_back({.center = {90, 1.0 * y}, .contrast = -60, .major_sd = 1.5, .minor_sd = 1.5});
  }
  for (int k = 0; k < kLeaves; ++k) {
    Rng rng(4, static_cast<std::uint64_t>(k));
    const double sway = 1.2 * std::sin(0.21 * frame) + 0.3 * std::sin(0.53 * frame + k);
    blobs.push_back(
        {.center = {rng.Uniform(210, 300) + sway, rng.Uniform(140, 190)}, .contrast = -90});
  }
  return blobs;
}

class FinderTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    fs::remove_all(Footage());
    fs::create_directories(Footage());
    for (int frame = 1; frame <= kFrames; ++frame) {
      const GrayImage picture = DrawPicture(kWidth, kHeight, {.level = 170, .noise = 1.5},
                                            Scene(frame), static_cast<std::uint64_t>(frame));
      const cv::Mat view(kHeight, kWidth, CV_8UC1,
                         const_cast<std::uint8_t*>(picture.pixels.data()));
      cv::imwrite((Footage() / (std::to_string(frame) + ".png")).string(), view);
    }
    whole_ = TrackVideo({}, Footage());
  }
  static void TearDownTestSuite() { fs::remove_all(Footage()); }
  static fs::path Footage() { return fs::path(testing::TempDir()) / "finder_test"; }

  static TrackerResult whole_;
};

TrackerResult FinderTest::whole_;

TEST_F(FinderTest, TheBirdsAreFollowedAndTheLeavesAreNot) {
  EXPECT_GT(whole_.report.clutter, 0);
  int near = 0, rows = 0;
  for (const Tracklet& tracklet : whole_.tracks.tracklets) {
    for (const Detection& d : tracklet.detections) {
      ++rows;
      for (int k = 0; k < kBirds; ++k) {
        const Vec2d p = d.box.Center(), q = Bird(k, d.frame);
        if (std::hypot(p.x - q.x, p.y - q.y) > 3) continue;
        ++near;
        break;
      }
    }
  }
  EXPECT_GT(near, 0.95 * kBirds * kFrames);
  EXPECT_LT(rows - near, 0.05 * kBirds * kFrames);
}

TEST_F(FinderTest, AKilledRunGoesOnWithoutWhatStands) {
  const CheckpointPlace place{fs::path(testing::TempDir()) / "finder_test_checkpoint",
                              std::chrono::seconds(0)};
  std::int64_t first = 0;
  const auto stop = [](std::int64_t done, std::int64_t) {
    if (done == kFrames - 10) throw std::runtime_error("killed");
  };
  EXPECT_THROW(TrackVideo({}, Footage(), stop, {}, place), std::runtime_error);
  const auto note = [&first](std::int64_t done, std::int64_t) { first = first > 0 ? first : done; };
  const TrackerResult again = TrackVideo({}, Footage(), note, {}, place);
  EXPECT_GT(first, 50);
  EXPECT_EQ(again.report.clutter, whole_.report.clutter);
  ASSERT_EQ(again.tracks.tracklets.size(), whole_.tracks.tracklets.size());
  for (std::size_t k = 0; k < again.tracks.tracklets.size(); ++k) {
    const auto &is = again.tracks.tracklets[k].detections,
               &was = whole_.tracks.tracklets[k].detections;
    ASSERT_EQ(is.size(), was.size());
    for (std::size_t t = 0; t < is.size(); ++t) {
      EXPECT_EQ(is[t].box.left, was[t].box.left);
      EXPECT_EQ(is[t].box.top, was[t].box.top);
    }
  }
}

}  // namespace
}  // namespace flocklift
