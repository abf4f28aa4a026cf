// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/persistence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

constexpr double kFps = 60;

// Rays by a function of time, for ten seconds, with noise.
template <typename Path>
std::vector<Segment> Seen(double ray_sd, const Path& path) {
  std::vector<Segment> segments;
  for (Id id = 1; id <= 3; ++id) {
    Rng rng(5, static_cast<std::uint64_t>(id));
    Segment segment{id, {}};
    for (int f = 0; f < 600; ++f) {
      Sighting s;
      s.frame = f + 1;
      s.time = f / kFps;
      s.ray = path(s.time, id);
      s.ray.x += ray_sd * rng.Normal();
      s.ray.y += ray_sd * rng.Normal();
      s.ray_sd = ray_sd;
      segment.sightings.push_back(s);
    }
    segments.push_back(segment);
  }
  return segments;
}

Vec2d Circle(double rate, double time) {
  return {0.02 * std::cos(rate * time), 0.02 * std::sin(rate * time)};
}

// A circle's velocity turns by rate * T: the cosine of that is left.
TEST(Persistence, OfCirclesByHand) {
  for (const double rate : {0.5, 1.0, 3.0, 2 * std::numbers::pi}) {
    const auto segments = Seen(0, [&](double time, Id) { return Circle(rate, time); });
    EXPECT_NEAR(PersistenceOf(segments), std::cos(rate * kPersistenceLag), 0.02) << rate;
  }
}

// Noise as large as the motion of a quarter of a second is taken out.
TEST(Persistence, DoesNotTakeNoiseForMotion) {
  const auto segments = Seen(0.003, [](double time, Id) { return Circle(1, time); });
  EXPECT_NEAR(PersistenceOf(segments), std::cos(kPersistenceLag), 0.1);
}

// Velocities that forget themselves with a time constant of 0.15 s.
TEST(Persistence, OfInsectsIsSmall) {
  std::vector<std::vector<Vec2d>> paths;
  for (std::uint64_t i = 0; i < 3; ++i) {
    Rng rng(9, i);
    Vec2d velocity, place;
    std::vector<Vec2d>& path = paths.emplace_back();
    const double rho = std::exp(-1 / (kFps * 0.15));
    for (int f = 0; f < 601; ++f) {
      path.push_back(place);
      velocity.x = rho * velocity.x + std::sqrt(1 - rho * rho) * 0.1 * rng.Normal();
      velocity.y = rho * velocity.y + std::sqrt(1 - rho * rho) * 0.1 * rng.Normal();
      place = {place.x + velocity.x / kFps, place.y + velocity.y / kFps};
    }
  }
  const auto segments = Seen(0, [&](double time, Id id) {
    return paths[static_cast<std::size_t>(id - 1)][static_cast<std::size_t>(time * kFps + 0.5)];
  });
  EXPECT_TRUE(IsErratic(PersistenceOf(segments)));
  EXPECT_LT(std::abs(PersistenceOf(segments)), 0.35);
}

TEST(Persistence, OfShortTracksIsNotToBeTold) {
  auto segments = Seen(0, [](double time, Id) { return Circle(20, time); });
  for (Segment& segment : segments) segment.sightings.resize(40);
  EXPECT_EQ(PersistenceOf(segments), 1);
  EXPECT_EQ(PersistenceOf({}), 1);
}

}  // namespace
}  // namespace flocklift
