// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/flight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

const Vec3d kUp{0, 0, 1};

Vec3d Axis(const Rotation3d& world_from_body, const Vec3d& axis_in_body) {
  return world_from_body * axis_in_body;
}

TEST(FlightTest, WithoutAccelerationTheWingsAreLevel) {
  const Vec3d velocity{3, -4, 2};
  const Rotation3d banked = WorldFromBankedBody(velocity, {}, kUp);
  const Rotation3d level = WorldFromLevelBody(velocity);
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(banked.m[k], level.m[k], 1e-12);
}

TEST(FlightTest, BankOfACoordinatedTurn) {
  // Flying along +x and turning left with 1 g: 45 degrees, left wing down.
  const Rotation3d world_from_body = WorldFromBankedBody({10, 0, 0}, {0, 9.81, 0}, kUp);
  const Vec3d z = Axis(world_from_body, {0, 0, 1});
  EXPECT_NEAR(z.x, 0, 1e-12);
  EXPECT_NEAR(z.y, std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(z.z, std::sqrt(0.5), 1e-9);
  EXPECT_LT(Axis(world_from_body, {0, 1, 0}).z, 0);  // body y is left
  EXPECT_NEAR(Axis(world_from_body, {1, 0, 0}).x, 1, 1e-12);
}

TEST(FlightTest, AlwaysARotationAndNeverUpsideDown) {
  for (std::uint64_t trial = 0; trial < 300; ++trial) {
    Rng rng(2, trial);
    Vec3d velocity{rng.Normal(), rng.Normal(), rng.Normal()};
    if (trial % 7 == 0) velocity = {};
    if (trial % 7 == 1) velocity = {0, 0, -3};
    const Vec3d acceleration =
        trial % 5 == 0 ? Vec3d{0, 0, -50} : 20.0 * Vec3d{rng.Normal(), rng.Normal(), rng.Normal()};
    const Rotation3d r = WorldFromBankedBody(velocity, acceleration, kUp);
    const Vec3d x = Axis(r, {1, 0, 0}), y = Axis(r, {0, 1, 0}), z = Axis(r, {0, 0, 1});
    EXPECT_NEAR(Norm(x), 1, 1e-12);
    EXPECT_NEAR(Norm(z), 1, 1e-12);
    EXPECT_NEAR(Norm(Cross(x, y) - z), 0, 1e-12);
    if (Norm(velocity) > 0) {
      EXPECT_NEAR(Norm(x - Normalized(velocity)), 0, 1e-12);
    }
    if (std::hypot(acceleration.x, acceleration.y) == 0) {
      EXPECT_GE(z.z, -1e-12);
    }
  }
}

// A bird on a horizontal circle, counter-clockwise seen from above.
Trajectories Circle(double speed, double radius, double fps, int frames) {
  Trajectories t;
  Trajectory& bird = t.trajectories.emplace_back();
  bird.id = 7;
  for (int frame = 3; frame < 3 + frames; ++frame) {
    const double angle = speed / radius * (frame - 1) / fps;
    TrajectoryPoint& point = bird.points.emplace_back();
    point.frame = frame;
    point.position = {radius * std::cos(angle), radius * std::sin(angle), 10};
  }
  return t;
}

TEST(FlightTest, CirclingBirdsBankByTheirCentripetalAcceleration) {
  Camera camera = PinholeCamera(60, 640, 480);
  camera.cam_from_world = LookAt({0, -50, 1.7}, {0, 0, 10});
  const Animal animal{.id = 7, .wingspan = 0.66};
  const Flight flight(Circle(10, 12, 30, 40), {&animal, 1}, camera, 30);
  EXPECT_EQ(flight.span().first, 3);
  EXPECT_EQ(flight.span().last, 42);
  EXPECT_TRUE(flight.At(2).empty());
  EXPECT_TRUE(flight.At(43).empty());
  const auto birds = flight.At(20);
  ASSERT_EQ(birds.size(), 1U);
  EXPECT_EQ(birds[0].animal.id, 7);
  EXPECT_EQ(birds[0].animal.wingspan, 0.66);
  EXPECT_NEAR(Norm(birds[0].velocity), 10, 0.05);
  const double bank = std::acos(Axis(birds[0].world_from_body, {0, 0, 1}).z);
  EXPECT_NEAR(bank, std::atan2(10.0 * 10 / 12, 9.81), 0.02);
  const Vec3d towards_centre =
      Normalized(Vec3d{} - Vec3d{birds[0].position.x, birds[0].position.y, 0});
  EXPECT_GT(Dot(Axis(birds[0].world_from_body, {0, 0, 1}), towards_centre), 0.5);
}

TEST(FlightTest, OrientationOfTheFileCounts) {
  Trajectories t = Circle(10, 12, 30, 5);
  t.has_orientation = true;
  const Rotation3d wanted = WorldFromLevelBody({1, 2, 3});
  for (auto& point : t.trajectories[0].points) {
    point.world_from_body = QuaternionFromRotation(wanted);
  }
  const Flight flight(t, {}, PinholeCamera(60, 640, 480), 30);
  const auto birds = flight.At(4);
  ASSERT_EQ(birds.size(), 1U);
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_NEAR(birds[0].world_from_body.m[k], wanted.m[k], 1e-12);
  }
}

TEST(FlightTest, WithoutGravityUpIsUpInTheImage) {
  Trajectories t;
  Trajectory& bird = t.trajectories.emplace_back();
  bird.id = 1;
  for (int frame = 1; frame <= 5; ++frame) {
    TrajectoryPoint& point = bird.points.emplace_back();
    point.frame = frame;
    point.position = {0.1 * frame, 0, 20};
  }
  const Flight flight(t, {}, PinholeCamera(60, 640, 480), 30);
  EXPECT_NEAR(Axis(flight.At(3)[0].world_from_body, {0, 0, 1}).y, -1, 1e-9);
}

TEST(FlightTest, NeedsAFrameRate) {
  EXPECT_THROW(Flight({}, {}, PinholeCamera(60, 640, 480), 0), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
