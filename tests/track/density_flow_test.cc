// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A murmuration of 5 000 birds, each a pixel or two wide: no identities, but how many and whither.

#include "track/density_flow.h"

#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "tests/track/pictures.h"
#include "track/tracker.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 640, kHeight = 480, kBirds = 5000, kFrames = 30;
constexpr Vec2d kVelocity{3, -1};  // [px/frame], of all; each has its own way besides

class DensityFlowTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::path(testing::TempDir()) / "density_flow_test_pictures";
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    for (int frame = 1; frame <= kFrames; ++frame) {
      std::vector<SoftBlob> birds;
      for (int k = 0; k < kBirds; ++k) {
        Rng rng(4, static_cast<std::uint64_t>(k));
        const double angle = rng.Uniform(0, 2 * std::numbers::pi);
        const double radius = 170 * std::sqrt(rng.Uniform(0, 1));
        const Vec2d v{kVelocity.x + 0.3 * rng.Normal(), kVelocity.y + 0.3 * rng.Normal()};
        Rng turns(5, static_cast<std::uint64_t>(k * 100 + frame));
        birds.push_back(
            {.center = {270 + radius * std::cos(angle) + v.x * frame + 0.7 * turns.Normal(),
                        260 + radius * std::sin(angle) + v.y * frame + 0.7 * turns.Normal()},
             .contrast = -90,
             .major_sd = 0.6,
             .minor_sd = 0.6});
      }
      const GrayImage picture = DrawPicture(kWidth, kHeight, {.level = 190, .noise = 1.5}, birds,
                                            static_cast<std::uint64_t>(frame));
      const cv::Mat view(kHeight, kWidth, CV_8UC1,
                         const_cast<std::uint8_t*>(picture.pixels.data()));
      cv::imwrite((folder_ / (std::to_string(frame) + ".png")).string(), view);
    }
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static fs::path folder_;
};

fs::path DensityFlowTest::folder_;

TEST_F(DensityFlowTest, NoTracksAreInvented) {
  const TrackerResult result = TrackVideo({}, folder_);
  EXPECT_FALSE(result.report.separability.is_enough);
  EXPECT_TRUE(result.tracks.tracklets.empty());
}

TEST_F(DensityFlowTest, CountsAndFlow) {
  const DensityFlow flow = MeasureDensityFlow({}, folder_);
  // Birds that hide each other are counted as fewer.
  EXPECT_GT(flow.median_count, 0.7 * kBirds);
  EXPECT_LT(flow.median_count, 1.05 * kBirds);
  EXPECT_NEAR(flow.median_speed, std::hypot(kVelocity.x, kVelocity.y), 0.3);
  EXPECT_GT(flow.polarisation, 0.95);
  // Where the flock is densest, too: its middle is one patch, larger than an animal can be.
  double count = 0;
  Vec2d sum{};
  for (const FlowCell& cell : flow.cells) {
    if (!cell.velocity) continue;
    count += cell.count;
    sum.x += cell.count * cell.velocity->x;
    sum.y += cell.count * cell.velocity->y;
  }
  ASSERT_GT(count, 0);
  EXPECT_NEAR(sum.x / count, kVelocity.x, 0.15);
  EXPECT_NEAR(sum.y / count, kVelocity.y, 0.15);
}

TEST_F(DensityFlowTest, WritesATable) {
  DensityFlow flow;
  flow.cells = {{1, {31.5, 31.5}, 12.25, Vec2d{1.5, -2}}, {6, {95.5, 31.5}, 3, std::nullopt}};
  const fs::path path = folder_ / "flow.csv";
  WriteDensityFlow(path, flow);
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  fs::remove(path);
  EXPECT_EQ(text, "frame,x,y,count,u,v\n1,31.5,31.5,12.25,1.500,-2.000\n6,95.5,31.5,3.00,,\n");
}

}  // namespace
}  // namespace flocklift
