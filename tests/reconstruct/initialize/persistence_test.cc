// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/persistence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

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

// Noise of a third of the motion of a quarter of a second is taken out.
TEST(Persistence, DoesNotTakeNoiseForMotion) {
  const auto segments = Seen(0.0015, [](double time, Id) { return Circle(1, time); });
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

// Three animals of 10 s tell; of 3 s they do not.
TEST(Persistence, OfLittleIsNotToBeTold) {
  auto segments = Seen(0, [](double time, Id) { return Circle(3, time); });
  EXPECT_TRUE(IsErratic(PersistenceOf(segments)));
  for (Segment& segment : segments) segment.sightings.resize(180);
  EXPECT_EQ(PersistenceOf(segments), 1);
  EXPECT_EQ(PersistenceOf({}), 1);
  EXPECT_EQ(PersistenceOf(Seen(0.003, [](double, Id) { return Vec2d{0.1, 0.2}; })), 1);
  EXPECT_EQ(PersistenceOf(Seen(0, [](double, Id) { return Vec2d{0.1, 0.2}; })), 1);
}

// One of three is an insect; some sightings of the others are far off, and said to be.
TEST(Persistence, IsTheMedianOfSureSightings) {
  auto segments = Seen(1e-5, [](double time, Id id) { return Circle(id == 2 ? 3 : 1, time); });
  for (std::size_t k = 7; k < 600; k += 20) {
    for (const std::size_t i : {0, 2}) {
      segments[i].sightings[k].ray.x += 0.05;
      segments[i].sightings[k].ray_sd = 0.05;
    }
  }
  EXPECT_NEAR(PersistenceOf(segments), std::cos(kPersistenceLag), 0.02);
}

}  // namespace
}  // namespace flocklift
