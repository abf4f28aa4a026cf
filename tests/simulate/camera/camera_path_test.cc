// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/camera/camera_path.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "simulate/camera/projection.h"

namespace flocklift {
namespace {

void ExpectNear(const Vec3d& a, const Vec3d& b, double tolerance) {
  EXPECT_LE(Norm(a - b), tolerance) << a.x << " " << a.y << " " << a.z;
}

const std::vector<CameraKey> kKeys{{1, {0, -20, 2}, {0, 0, 5}},
                                   {2, {10, -15, 4}, {0, 0, 6}},
                                   {5, {15, 0, 3}, {1, 2, 5}},
                                   {6, {10, 12, 8}, {0, 1, 5}}};

TEST(CameraPathTest, PassesThroughItsKeysAndRestsOutside) {
  for (const CameraKey& key : kKeys) {
    ExpectNear(CameraKeyAt(kKeys, key.time).position, key.position, 1e-12);
    ExpectNear(CameraKeyAt(kKeys, key.time).look_at, key.look_at, 1e-12);
  }
  EXPECT_EQ(CameraKeyAt(kKeys, -3).position, kKeys.front().position);
  EXPECT_EQ(CameraKeyAt(kKeys, 99).look_at, kKeys.back().look_at);
  EXPECT_EQ(CameraKeyAt(kKeys, 99).time, 99);
}

// Two keys: 3 t^2 - 2 t^3 of the way.
TEST(CameraPathTest, ByHand) {
  const std::vector<CameraKey> keys{{0, {0, 0, 0}, {0, 1, 0}}, {2, {8, 0, 0}, {0, 9, 0}}};
  ExpectNear(CameraKeyAt(keys, 0.5).position, {8 * (3.0 / 16 - 2.0 / 64), 0, 0}, 1e-12);
  ExpectNear(CameraKeyAt(keys, 1).look_at, {0, 5, 0}, 1e-12);
}

constexpr double kStep = 1e-6;  // [s]

TEST(CameraPathTest, VelocityHasNoJump) {
  const auto velocity = [](double from) {
    return (CameraKeyAt(kKeys, from + kStep).position - CameraKeyAt(kKeys, from).position) / kStep;
  };
  for (const CameraKey& key : kKeys) {
    ExpectNear(velocity(key.time - 1.5 * kStep), velocity(key.time + 0.5 * kStep), 1e-3);
  }
  ExpectNear(velocity(kKeys[0].time), {}, 1e-3);
}

// Through points of a parabola the inner velocities are exact, and so is the curve between them.
TEST(CameraPathTest, ReproducesAParabolaBetweenInnerKeys) {
  const auto parabola = [](double t) { return Vec3d{1 + 2 * t, 3 * t * t, -t + 0.5 * t * t}; };
  std::vector<CameraKey> keys;
  for (const double t : {0.0, 1.0, 2.5, 3.0}) keys.push_back({t, parabola(t), {0, 0, 99}});
  for (const double t : {1.1, 1.7, 2.4}) {
    ExpectNear(CameraKeyAt(keys, t).position, parabola(t), 1e-12);
  }
}

TEST(CameraPathTest, FramesLookAtTheirPoint) {
  const std::vector<Rigid3d> poses = FollowKeys(kKeys, 10, 70);
  ASSERT_EQ(poses.size(), 70U);
  const Camera camera = PinholeCamera(60, 100, 80);
  for (int frame = 1; frame <= 70; ++frame) {
    const CameraKey at = CameraKeyAt(kKeys, (frame - 1) / 10.0);
    const Rigid3d& pose = poses[static_cast<std::size_t>(frame - 1)];
    ExpectNear(pose.Inverse().translation, at.position, 1e-9);
    const Vec2d pixel = Project(camera.intrinsics, pose * at.look_at);
    EXPECT_NEAR(pixel.x, 49.5, 1e-9);
    EXPECT_NEAR(pixel.y, 39.5, 1e-9);
  }
}

TEST(CameraPathTest, RefusesWhatIsNoPath) {
  EXPECT_THROW(CameraKeyAt({}, 0), std::invalid_argument);
  std::vector<CameraKey> keys = kKeys;
  keys[2].time = keys[1].time;
  EXPECT_THROW(CameraKeyAt(keys, 0), std::invalid_argument);
  keys = kKeys;
  keys[0].look_at = keys[0].position;
  EXPECT_THROW(FollowKeys(keys, 10, 5), std::invalid_argument);
  EXPECT_THROW(FollowKeys(kKeys, 0, 5), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
