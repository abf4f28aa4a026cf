// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/observability.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/reconstruct/circling_flock.h"

namespace flocklift {
namespace {

// An animal whose ray follows a circle of the image by `turn` in `seconds`.
Segment Turning(double turn, double seconds) {
  Segment segment{1, {}};
  const int frames = static_cast<int>(30 * seconds);
  for (int f = 0; f <= frames; ++f) {
    Sighting s;
    s.frame = f + 1;
    s.time = f / 30.0;
    const double angle = turn * f / frames;
    s.ray =
        turn > 0 ? Vec2d{0.2 * std::sin(angle), 0.2 * std::cos(angle)} : Vec2d{0.05 * s.time, 0.1};
    s.log_size = std::log(0.01);
    segment.sightings.push_back(s);
  }
  return segment;
}

Segments Some(double turn, double seconds) {
  Segments segments;
  segments.segments.assign(5, Turning(turn, seconds));
  return segments;
}

TEST(Observability, MeasuresTheTurnInTheImage) {
  const Observability half = LookAhead(Some(std::numbers::pi, 5));
  // Between the first and the last of ten chords of a half circle.
  EXPECT_NEAR(half.image_turn, 0.9 * std::numbers::pi, 1e-6);
  EXPECT_NEAR(half.speed_change, 0, 1e-6);
  EXPECT_NEAR(half.duration, 5, 1e-9);
  const Observability straight = LookAhead(Some(0, 5));
  EXPECT_NEAR(straight.image_turn, 0, 1e-9);
  EXPECT_EQ(straight.sizes, 1);
}

TEST(Observability, SpeedChangeIsALogarithm) {
  Segments segments = Some(0, 4);
  for (Segment& segment : segments.segments) {
    for (Sighting& s : segment.sightings) s.ray.x = 0.05 * s.time * s.time;
  }
  // Mean speeds of the first and the last half second: 0.025 and 0.375.
  EXPECT_NEAR(LookAhead(segments).speed_change, std::log(15.0), 1e-9);
}

TEST(Observability, NamesTransitsTurnsAndShortTracks) {
  const Knowledge with_size;
  Knowledge without = with_size;
  without.use_size = false;
  const auto text = [](const Segments& s, const Knowledge& k) { return Describe(LookAhead(s), k); };
  EXPECT_EQ(text(Some(0, 5), with_size).find("straight transit: relative depth rests on equal"),
            0u);
  EXPECT_NE(text(Some(0, 5), with_size).find("apparent size"), std::string::npos);
  EXPECT_EQ(text(Some(0, 5), without).find("apparent size"), std::string::npos);
  EXPECT_NE(text(Some(0, 5), without).find("expect little"), std::string::npos);
  EXPECT_EQ(text(Some(3, 5), without).find("turning flight: "), 0u);
  EXPECT_EQ(text(Some(3, 1), without).find("short tracks: "), 0u);
}

TEST(Observability, NothingIsNoFault) {
  const Observability o = LookAhead({});
  EXPECT_EQ(o.image_turn, 0);
  EXPECT_FALSE(Describe(o, {}).empty());
}

}  // namespace
}  // namespace flocklift
