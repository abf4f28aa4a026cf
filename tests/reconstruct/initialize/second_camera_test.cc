// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/second_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "reconstruct/initialize/triangulation.h"
#include "reconstruct/reconstruct.h"
#include "tests/reconstruct/circling_flock.h"

namespace flocklift {
namespace {

// A camera 60 degrees around the flock from the first one, with a clock of its own.
class SecondCameraTest : public testing::Test {
 protected:
  static constexpr double kOffset = 0.37;  // [s]

  SecondCameraTest() {
    second_.camera = PinholeCamera(60, 1280, 720);
    second_.camera.cam_from_world = LookAt({-40, -25, 3}, {0, 0, 15});
    second_.fps = 25;
    // The same flock at the second camera's times: frame k shows time (k - 1) / 25 + offset.
    FlockSpec spec = flock_;
    spec.fps = 30 * 25;
    spec.frames = flock_.frames * 25;
    const Trajectories fine = CirclingFlock(spec);
    Trajectories seen;
    seen.fps = second_.fps;
    for (const Trajectory& path : fine.trajectories) {
      Trajectory& copy = seen.trajectories.emplace_back(Trajectory{path.id, {}});
      for (int frame = 1;; ++frame) {
        const double time = (frame - 1) / second_.fps + kOffset;
        const auto at = static_cast<std::size_t>(std::lround(time * spec.fps));
        if (at >= path.points.size()) break;
        copy.points.push_back(path.points[at]);
        copy.points.back().frame = frame;
      }
    }
    FlockSpec at_25 = flock_;
    at_25.fps = second_.fps;
    second_.tracks = Observe(at_25, {.seed = 99}, seen, second_.camera);
    // Other ids, in another order.
    for (Tracklet& t : second_.tracks.tracklets) t.id = 1 + (5 * t.id) % 13;
    std::sort(second_.tracks.tracklets.begin(), second_.tracks.tracklets.end(),
              [](const Tracklet& a, const Tracklet& b) { return a.id < b.id; });
  }

  FlockSpec flock_;
  Camera camera_ = WatchingCamera();
  Trajectories truth_ = CirclingFlock(flock_);
  Tracks tracks_ = Observe(flock_, {}, truth_, camera_);
  SecondCamera second_;
};

// Every track finds its animal: the views' rays meet the first camera's at the true depths.
TEST_F(SecondCameraTest, TracksFindTheirAnimalsAndTheClock) {
  Segments segments = MakeSegments({}, tracks_, camera_, flock_.fps);
  const ReferenceAxes axes(camera_, 1, flock_.frames);
  const SecondCameraReport report = AttachViews(second_, {}, axes, 1, flock_.fps, &segments);
  EXPECT_EQ(report.tracks, flock_.count);
  EXPECT_EQ(report.matched, flock_.count);
  EXPECT_NEAR(report.offset, kOffset, 0.004);  // a tenth of its frame
  EXPECT_LT(report.error, 1.5);
  const DepthPairs depths = PairDepths(truth_, truth_, camera_);
  long checked = 0;
  for (const Segment& segment : segments.segments) {
    for (const View& view : segment.views) {
      const int frame = 1 + static_cast<int>(std::lround(view.time * flock_.fps));
      const auto depth = TriangulatedDepth(*RayAt(segment, view.time), view);
      ASSERT_TRUE(depth);
      EXPECT_NEAR(*depth / depths.at({segment.id, frame}).first, 1, 0.03);
      ++checked;
    }
  }
  EXPECT_EQ(checked, report.views);
  EXPECT_GT(checked, 100L * flock_.count);
}

// A second camera fixes the scale and the depths, better than anything else that is known.
TEST_F(SecondCameraTest, DepthsFollow) {
  ReconstructOptions options;
  options.second_camera = second_;
  const auto result = Reconstruct(options, tracks_, camera_, flock_.fps, 1, {});
  std::vector<double> errors;
  for (const auto& [key, pair] : PairDepths(truth_, result.trajectories, camera_)) {
    errors.push_back(std::abs(pair.second / pair.first - 1));
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.004);
  EXPECT_LT(errors[errors.size() * 9 / 10], 0.015);
  EXPECT_LT(result.report.scale_sd, 0.005);
  EXPECT_EQ(result.report.scale_from, "second camera");
}

// The clock may be stated; a wrong one fits badly, and the summary says so.
TEST_F(SecondCameraTest, AWrongClockIsTold) {
  ReconstructOptions options;
  options.knowledge.speed = Uncertain{10, 1};
  options.second_camera = second_;
  options.second_camera->offset = kOffset + 1;
  const auto result = Reconstruct(options, tracks_, camera_, flock_.fps, 1, {});
  EXPECT_EQ(result.report.second_camera->offset, kOffset + 1);
  EXPECT_LT(result.report.second_camera->matched, flock_.count / 2);
  ASSERT_FALSE(result.report.warnings.empty());
}

// Sequences in windows keep their views.
TEST_F(SecondCameraTest, WindowsHaveTheirViews) {
  ReconstructOptions options;
  options.second_camera = second_;
  options.batch.window = 1.5;
  options.batch.overlap = 0.5;
  const auto result = Reconstruct(options, tracks_, camera_, flock_.fps, 1, {});
  for (const auto& [key, pair] : PairDepths(truth_, result.trajectories, camera_)) {
    EXPECT_NEAR(pair.second / pair.first, 1, 0.12);
  }
}

TEST_F(SecondCameraTest, StrangersFixNoScale) {
  ReconstructOptions options;
  options.second_camera = second_;
  options.second_camera->offset = kOffset + 50;  // never at the same time
  EXPECT_THROW(Reconstruct(options, tracks_, camera_, flock_.fps, 1, {}), std::invalid_argument);
  options.knowledge.speed = Uncertain{10, 1};
  const auto result = Reconstruct(options, tracks_, camera_, flock_.fps, 1, {});
  EXPECT_EQ(result.report.second_camera->views, 0);
  EXPECT_TRUE(result.report.IsUsable());
}

TEST_F(SecondCameraTest, CobylaTakesNone) {
  ReconstructOptions options;
  options.knowledge.speed = Uncertain{10, 1};
  options.second_camera = second_;
  options.method = ReconstructMethod::kCobyla;
  EXPECT_THROW(Reconstruct(options, tracks_, camera_, flock_.fps, 1, {}), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
