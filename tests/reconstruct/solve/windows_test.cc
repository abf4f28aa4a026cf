// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/windows.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reconstruct/reconstruct.h"
#include "tests/reconstruct/circling_flock.h"

namespace flocklift {
namespace {

using namespace internal;  // NOLINT: the parts under test

Segments Seen(double seconds, double fps) {
  Segments segments;
  for (Id id = 1; id <= 3; ++id) {
    Segment segment{id, {}};
    // The second one enters late and leaves early.
    const double first = id == 2 ? 0.3 * seconds : 0, last = id == 2 ? 0.5 * seconds : seconds;
    for (int f = static_cast<int>(first * fps); f <= static_cast<int>(last * fps); ++f) {
      Sighting s;
      s.frame = f + 1;
      s.time = f / fps;
      segment.sightings.push_back(s);
    }
    segments.segments.push_back(segment);
  }
  return segments;
}

TEST(Windows, ShortSequencesStayWhole) {
  EXPECT_EQ(CutIntoWindows(Seen(17, 10), 12, 3).size(), 1u);
  EXPECT_EQ(CutIntoWindows(Seen(19, 10), 12, 3).size(), 2u);
  EXPECT_EQ(CutIntoWindows(Seen(60, 10), 12, 3).size(), 5u);
}

// At every time the weights of all windows add up to one, and every sighting is in the parts of
// just those windows that weigh it.
TEST(Windows, WeightsAddUpToOne) {
  constexpr double kFps = 10;
  const Segments segments = Seen(60, kFps);
  const std::vector<Window> windows = CutIntoWindows(segments, 12, 3);
  std::vector<std::vector<double>> sums;
  for (const Segment& s : segments.segments) sums.emplace_back(s.sightings.size(), 0.0);
  for (const Window& window : windows) {
    const WindowPart part = PartOf(segments, window, kFps, 1);
    for (std::size_t i = 0; i < part.segment.size(); ++i) {
      for (std::size_t k = 0; k < part.segments.segments[i].sightings.size(); ++k) {
        const Sighting& whole = segments.segments[part.segment[i]].sightings[part.sighting[i] + k];
        const Sighting& cut = part.segments.segments[i].sightings[k];
        EXPECT_EQ(cut.frame, whole.frame);
        EXPECT_NEAR(cut.time, (whole.frame - part.first_frame) / kFps, 1e-9);
        EXPECT_GE(cut.time, -1e-9);
        EXPECT_GT(window.Weight(whole.time), 0);
        sums[part.segment[i]][part.sighting[i] + k] += window.Weight(whole.time);
      }
    }
  }
  for (const auto& of_segment : sums) {
    for (const double sum : of_segment) EXPECT_NEAR(sum, 1, 1e-9);
  }
}

// The same flock solved whole and in windows: the same paths within what they claim to know, no
// jumps where windows meet, one scale.
TEST(Windows, AgreeWithTheWhole) {
  const FlockSpec flock{.count = 8, .frames = 240};
  const Camera camera = WatchingCamera();
  const Trajectories truth = CirclingFlock(flock);
  const Tracks tracks = Observe(flock, {}, truth, camera);
  ReconstructOptions options;
  options.knowledge.speed = Uncertain{flock.speed, 1};
  options.knowledge.wingspan = Uncertain{flock.wingspan, 0.03};
  const auto whole = Reconstruct(options, tracks, camera, flock.fps, 1, {});
  options.batch.window = 2.5;
  options.batch.overlap = 1;
  const auto pieces = Reconstruct(options, tracks, camera, flock.fps, 1, {});
  EXPECT_NEAR(pieces.report.scale_sd, whole.report.scale_sd, 0.02);
  double squares = 0, count = 0;
  for (std::size_t i = 0; i < whole.trajectories.trajectories.size(); ++i) {
    const auto& a = whole.trajectories.trajectories[i].points;
    const auto& b = pieces.trajectories.trajectories[i].points;
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
      const double sd = std::hypot(a[k].sd_depth, b[k].sd_depth);
      squares += SquaredNorm(a[k].position - b[k].position) / (sd * sd);
      count += 1;
      if (k > 0) {
        EXPECT_LT(Norm(b[k].position - b[k - 1].position) * flock.fps, 1.8 * flock.speed);
      }
    }
  }
  EXPECT_LT(std::sqrt(squares / count), 0.7);
}

}  // namespace
}  // namespace flocklift
