// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What becomes of a track whose image motion jumps: another animal from there on, or a glitch.

#include <gtest/gtest.h>

#include <cmath>

#include "reconstruct/initialize/segments.h"
#include "simulate/core/rng.h"

namespace flocklift {
namespace {

constexpr double kFps = 30;
constexpr int kFrames = 120;

Camera PlainCamera() {
  Camera camera;
  camera.width = 1920;
  camera.height = 1080;
  camera.intrinsics = {.fx = 2000, .fy = 2000, .cx = 959.5, .cy = 539.5, .distortion = {}};
  return camera;
}

Detection At(int frame, double u, double v) {
  return {.frame = frame, .box = Box::Around({u, v}, 20, 12), .confidence = 1, .shape = {}};
}

// Ten animals on gently curved paths, 90 px apart, with half a pixel of noise.
Tracks CurvedTracks() {
  Tracks tracks;
  for (Id id = 1; id <= 10; ++id) {
    Rng rng(3, static_cast<std::uint64_t>(id));
    Tracklet tracklet{.id = id, .detections = {}};
    for (int frame = 1; frame <= kFrames; ++frame) {
      const double t = frame / kFps;
      tracklet.detections.push_back(
          At(frame, 200 + 150 * t + 0.5 * rng.Normal(),
             90.0 * static_cast<double>(id) + 20 * std::sin(t) + 0.5 * rng.Normal()));
    }
    tracks.tracklets.push_back(tracklet);
  }
  return tracks;
}

void Shift(Detection* detection, double du, double dv) {
  detection->box.left += du;
  detection->box.top += dv;
}

TEST(Jumps, SmoothTracksStayWhole) {
  const Segments segments = MakeSegments({}, CurvedTracks(), PlainCamera(), kFps);
  EXPECT_EQ(segments.cuts, 0);
  EXPECT_EQ(segments.segments.size(), 10U);
  EXPECT_NEAR(segments.pixel_sd, 0.5, 0.05);
}

TEST(Jumps, AnotherAnimalFromThereOnIsCut) {
  Tracks tracks = CurvedTracks();
  for (int k = 60; k < kFrames; ++k) Shift(&tracks.tracklets[4].detections[k], 0, 90);
  const Segments segments = MakeSegments({}, tracks, PlainCamera(), kFps);
  EXPECT_EQ(segments.cuts, 1);
  ASSERT_EQ(segments.segments.size(), 11U);
  EXPECT_EQ(segments.segments[4].id, 5);
  EXPECT_EQ(segments.segments[5].id, 5);
  EXPECT_EQ(segments.segments[5].sightings.front().frame, 61);
}

TEST(Jumps, AGlitchIsBridgedAndCountsLittle) {
  Tracks tracks = CurvedTracks();
  for (int k = 60; k < 66; ++k) Shift(&tracks.tracklets[4].detections[k], 10, 12);
  const Segments segments = MakeSegments({}, tracks, PlainCamera(), kFps);
  EXPECT_EQ(segments.cuts, 0);
  const auto& s = segments.segments[4].sightings;
  for (int k = 60; k < 66; ++k) {
    EXPECT_GT(s[k].ray_sd, 10 * s[20].ray_sd) << k;
    EXPECT_FALSE(s[k].log_size) << k;
  }
  EXPECT_TRUE(s[20].log_size);
  EXPECT_TRUE(s[90].log_size);
}

TEST(Jumps, AShortOddEndIsNoAnimalOfItsOwn) {
  Tracks tracks = CurvedTracks();
  for (int k = kFrames - 7; k < kFrames; ++k) Shift(&tracks.tracklets[4].detections[k], 0, 30);
  EXPECT_EQ(MakeSegments({}, tracks, PlainCamera(), kFps).cuts, 0);
}

TEST(Jumps, BoxesCutOffByTheEdgeHaveNoSize) {
  Tracks tracks = CurvedTracks();
  tracks.tracklets[0].detections[0].box = {0, 80, 6, 12};
  const Segments segments = MakeSegments({}, tracks, PlainCamera(), kFps);
  const auto& s = segments.segments[0].sightings;
  EXPECT_FALSE(s[0].log_size);
  EXPECT_GT(s[0].ray_sd, 5 * s[20].ray_sd);
}

TEST(Jumps, AreNeverCutWhenSwitchedOff) {
  Tracks tracks = CurvedTracks();
  for (int k = 60; k < kFrames; ++k) Shift(&tracks.tracklets[4].detections[k], 0, 90);
  SegmentOptions options;
  options.jump = 0;
  EXPECT_EQ(MakeSegments(options, tracks, PlainCamera(), kFps).cuts, 0);
}

}  // namespace
}  // namespace flocklift
