// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include "simulate/core/rng.h"
#include "track/tracker.h"

namespace flocklift {
namespace {

// One animal on a straight line, in frames first .. last but one.
Tracklet Line(Id id, int first, int last, int left_out = 0) {
  Tracklet tracklet{id, {}};
  for (int frame = first; frame <= last; ++frame) {
    if (frame == left_out) continue;
    Rng rng(static_cast<std::uint64_t>(id), static_cast<std::uint64_t>(frame));
    Detection d;
    d.frame = frame;
    d.box = Box::Around({20 + 4.0 * frame + 0.1 * rng.Normal(), 100 + 0.1 * rng.Normal()}, 8, 8);
    d.confidence = 0.9;
    tracklet.detections.push_back(d);
  }
  return tracklet;
}

Tracklet Elsewhere(Id id, double y) {
  Tracklet tracklet = Line(id, 1, 60);
  for (Detection& d : tracklet.detections) d.box.top += y;
  return tracklet;
}

TEST(ContinueTracksTest, JoinsAndFillsAndKeepsWhatWasGiven) {
  const Tracks given{50.0,
                     {Line(7, 1, 25, 12), Line(30, 36, 60), Elsewhere(31, 80), Elsewhere(40, 200)}};
  const TrackerResult result = ContinueTracks({}, given, 640, 480);
  EXPECT_EQ(result.report.joins, 1);
  EXPECT_EQ(result.report.filled_rows, 11);
  EXPECT_EQ(result.tracks.fps, 50.0);
  ASSERT_EQ(result.tracks.tracklets.size(), 3u);
  const Tracklet& joined = result.tracks.tracklets[0];
  EXPECT_EQ(joined.id, 7);
  ASSERT_EQ(joined.detections.size(), 60u);
  std::size_t next = 0;
  std::vector<Detection> rows = given.tracklets[0].detections;
  rows.insert(rows.end(), given.tracklets[1].detections.begin(),
              given.tracklets[1].detections.end());
  for (const Detection& d : joined.detections) {
    if (next < rows.size() && d.frame == rows[next].frame) {
      EXPECT_EQ(d.box.left, rows[next].box.left);
      EXPECT_EQ(d.confidence, 0.9);
      ++next;
    } else {
      EXPECT_LT(d.confidence, kMeasuredConfidence);
      EXPECT_NEAR(d.box.Center().x, 20 + 4.0 * d.frame, 2);
    }
  }
  EXPECT_EQ(next, rows.size());
}

// A person's short or motionless track is not ours to drop.
TEST(ContinueTracksTest, DropsNothing) {
  Tracklet still{5, {}};
  for (int frame = 1; frame <= 60; ++frame) {
    Detection d;
    d.frame = frame;
    d.box = Box::Around({50, 50}, 8, 8);
    still.detections.push_back(d);
  }
  Tracklet once{6, {still.detections[0]}};
  const TrackerResult result = ContinueTracks({}, {{}, {still, once}}, 640, 480);
  ASSERT_EQ(result.tracks.tracklets.size(), 2u);
  EXPECT_EQ(result.tracks.tracklets[0].detections.size(), 60u);
  EXPECT_EQ(result.tracks.tracklets[1].detections.size(), 1u);
}

}  // namespace
}  // namespace flocklift
