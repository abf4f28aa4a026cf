// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/track_faults.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace flocklift {
namespace {

// Animals side by side, 10 px apart, in every frame.
Tracks Rows(int animals, int frames) {
  Tracks tracks{.fps = 30, .tracklets = {}};
  for (Id id = 1; id <= animals; ++id) {
    Tracklet& tracklet = tracks.tracklets.emplace_back();
    tracklet.id = id;
    for (int frame = 1; frame <= frames; ++frame) {
      tracklet.detections.push_back(
          {.frame = frame,
           .box = Box::Around({10.0 * static_cast<double>(id), 1.0 * frame}, 20, 10),
           .shape = Shape{20, 10, 0, 150}});
    }
  }
  return tracks;
}

TEST(TrackFaultsTest, NoFaultsLeaveTheTracksAlone) {
  const Tracks tracks = Rows(3, 50);
  const Tracks same = SynthesizeFaults({}, 1, 30, tracks);
  ASSERT_EQ(same.tracklets.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_EQ(same.tracklets[i].detections.size(), 50u);
    for (std::size_t k = 0; k < 50; ++k) {
      EXPECT_NEAR(same.tracklets[i].detections[k].box.width, 20, 1e-12);
    }
  }
  EXPECT_TRUE(SynthesizeSwitches({}, 1, tracks).empty());
}

TEST(TrackFaultsTest, GapsComeAsOftenAndLastAsLongAsAsked) {
  const TrackFaults faults{.gaps = 5, .gap_length = 8};
  const Tracks seen = SynthesizeFaults(faults, 3, 30, Rows(50, 2000));
  long rows = 0, gaps = 0, missing = 0;
  for (const Tracklet& tracklet : seen.tracklets) {
    int last = 0;
    for (const Detection& d : tracklet.detections) {
      if (d.frame != last + 1) ++gaps;
      missing += d.frame - last - 1;
      last = d.frame;
      ++rows;
    }
  }
  // Gaps that begin inside others are lengthened: a few per cent fewer and longer.
  EXPECT_NEAR(static_cast<double>(gaps) / (50 * 2000), 0.005, 0.0008);
  EXPECT_NEAR(static_cast<double>(missing) / static_cast<double>(gaps), 8.5, 1.2);
}

TEST(TrackFaultsTest, SizesDriftWithTheirSdAndTime) {
  const TrackFaults faults{.size_drift_sd = 0.1, .size_drift_time = 2};
  const Tracks seen = SynthesizeFaults(faults, 5, 30, Rows(200, 600));
  constexpr int kLag = 60;  // 2 s: correlation 1/e
  double square = 0, product = 0;
  long n = 0, m = 0;
  for (const Tracklet& tracklet : seen.tracklets) {
    const auto error = [&](std::size_t k) {
      return std::log(tracklet.detections[k].box.width / 20);
    };
    for (std::size_t k = 0; k < tracklet.detections.size(); ++k, ++n) square += error(k) * error(k);
    for (std::size_t k = kLag; k < tracklet.detections.size(); ++k, ++m) {
      product += error(k) * error(k - kLag);
    }
    const Detection& first = tracklet.detections.front();
    EXPECT_NEAR(first.shape->major, first.box.width, 1e-9);
    EXPECT_NEAR(first.shape->area / 150, std::pow(first.box.width / 20, 2), 1e-9);
  }
  const double variance = square / static_cast<double>(n);
  EXPECT_NEAR(std::sqrt(variance), 0.1, 0.005);
  EXPECT_NEAR(product / static_cast<double>(m) / variance, std::exp(-1.0), 0.06);
}

TEST(TrackFaultsTest, SwitchesTradeNamesFromTheirFrameOn) {
  const Tracks tracks = Rows(3, 10);
  const std::vector<IdentitySwitch> switches = {{4, 1, 2}, {7, 1, 3}};
  const Tracks renamed = WithSwitches(switches, tracks);
  // Animal by name and frame, told by its column.
  const auto animal = [&](Id name, int frame) -> Id {
    for (const Tracklet& t : renamed.tracklets) {
      if (t.id != name) continue;
      for (const Detection& d : t.detections) {
        if (d.frame == frame) return std::lround(d.box.Center().x / 10);
      }
    }
    return 0;
  };
  EXPECT_EQ(animal(1, 3), 1);
  EXPECT_EQ(animal(1, 4), 2);
  EXPECT_EQ(animal(2, 4), 1);
  EXPECT_EQ(animal(2, 6), 1);
  EXPECT_EQ(animal(2, 7), 3);  // animal 1 passes the name 2 on to animal 3
  EXPECT_EQ(animal(3, 7), 1);
  EXPECT_EQ(animal(1, 10), 2);
  for (const Tracklet& t : renamed.tracklets) EXPECT_EQ(t.detections.size(), 10u);
}

TEST(TrackFaultsTest, TruthIsRenamedAsTheTracksAre) {
  const TrackFaults faults{.switches = 10};
  const Tracks tracks = Rows(6, 200);
  Trajectories truth;
  for (const Tracklet& t : tracks.tracklets) {
    Trajectory& path = truth.trajectories.emplace_back();
    path.id = t.id;
    for (const Detection& d : t.detections) {
      TrajectoryPoint point;
      point.frame = d.frame;
      point.position = {d.box.Center().x, d.box.Center().y, 0};
      path.points.push_back(point);
    }
  }
  const auto switches = SynthesizeSwitches(faults, 9, tracks);
  EXPECT_NEAR(static_cast<double>(switches.size()), 12, 10);
  for (const IdentitySwitch& s : switches) EXPECT_EQ(std::abs(s.a - s.b), 1);  // neighbours
  const Tracks named = WithSwitches(switches, tracks);
  const Trajectories named_truth = WithSwitches(switches, truth);
  ASSERT_EQ(named.tracklets.size(), named_truth.trajectories.size());
  for (std::size_t i = 0; i < named.tracklets.size(); ++i) {
    ASSERT_EQ(named.tracklets[i].id, named_truth.trajectories[i].id);
    ASSERT_EQ(named.tracklets[i].detections.size(), named_truth.trajectories[i].points.size());
    for (std::size_t k = 0; k < named.tracklets[i].detections.size(); ++k) {
      EXPECT_EQ(named.tracklets[i].detections[k].box.Center().x,
                named_truth.trajectories[i].points[k].position.x);
    }
  }
}

}  // namespace
}  // namespace flocklift
