// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "simulate/camera/projection.h"
#include "simulate/core/rng.h"

namespace flocklift {
namespace {

constexpr double kPi = std::numbers::pi;

// The extent of all parts along each axis of the body frame.
struct Extent {
  Vec3d low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  explicit Extent(const std::vector<BodyPart>& parts) {
    for (const BodyPart& part : parts) {
      for (int k = 0; k < part.corners; ++k) {
        const Vec3d& p = part.corner[k];
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      }
    }
  }
};

TEST(BodyTest, LevelWingsMeasureTheWingspan) {
  const Animal gliding{.id = 1, .wingspan = 1.2, .body_length = 0.5, .wingbeat_hz = 0};
  const Extent glide(BodyParts(gliding, 3.7, {0, 0, 100}));
  EXPECT_NEAR(glide.high.y - glide.low.y, 1.2, 1e-12);
  EXPECT_NEAR(glide.high.x - glide.low.x, 0.5, 0.01);

  // In the middle of the downstroke, half a beat after the middle of the upstroke.
  const Animal flapping{.id = 1, .wingspan = 1.2, .body_length = 0.5, .wingbeat_hz = 4};
  const Extent down(BodyParts(flapping, 0.125, {0, 0, 100}));
  EXPECT_NEAR(down.high.y - down.low.y, 1.2, 1e-12);
  const Extent up(BodyParts(flapping, 0.25, {0, 0, 100}));
  EXPECT_LT(up.high.y - up.low.y, 1.1);
}

TEST(BodyTest, WingsBeatAtTheirFrequencyAndPhase) {
  const Animal a{.id = 1, .wingbeat_hz = 5, .wingbeat_phase = 0.7};
  const Extent now(BodyParts(a, 1.0, {0, 100, 0})), later(BodyParts(a, 1.2, {0, 100, 0}));
  EXPECT_NEAR(now.high.z, later.high.z, 1e-9);
  const Animal b{.id = 1, .wingbeat_hz = 5, .wingbeat_phase = 0.7 + kPi / 2};
  const Extent ahead(BodyParts(b, 1.0, {0, 100, 0})), quarter(BodyParts(a, 1.05, {0, 100, 0}));
  EXPECT_NEAR(ahead.high.z, quarter.high.z, 1e-9);
  double highest = -1, lowest = 1;
  for (double t = 0; t < 0.2; t += 0.005) {
    const Extent extent(BodyParts(a, t, {0, 100, 0}));
    highest = std::max(highest, extent.high.z);
    lowest = std::min(lowest, extent.low.z);
  }
  EXPECT_GT(highest, 0.15 * a.wingspan);
  EXPECT_LT(lowest, -0.25 * a.wingspan);
}

TEST(BodyTest, SymmetricAboutItsMiddle) {
  const Animal a{.id = 1};
  for (double t : {0.0, 0.03, 0.11}) {
    const Extent extent(BodyParts(a, t, {0, 0, 50}));
    EXPECT_NEAR(extent.low.y, -extent.high.y, 1e-12);
  }
}

// The rim of the spindle must enclose what its surface projects to, and no more.
TEST(BodyTest, SpindleRimIsItsOutline) {
  const Animal a{.id = 1, .wingspan = 0.7, .body_length = 0.4};
  for (const Vec3d& viewer : {Vec3d{30, 0, 0}, Vec3d{0, 30, 0}, Vec3d{10, 20, -15}}) {
    const BodyPart rim = BodyParts(a, 0, viewer)[0];
    const Vec3d sight = Normalized(viewer);
    const Vec3d right = Normalized(Cross(sight, Vec3d{0.1, 0.2, 0.9})), up = Cross(sight, right);
    // Support function of the ellipsoid along directions across the line of sight.
    for (double angle = 0; angle < 2 * kPi; angle += 0.3) {
      const Vec3d d = std::cos(angle) * right + std::sin(angle) * up;
      const double support =
          0.4 * (0.08 * d.x + std::sqrt(std::pow(0.42 * d.x, 2) + std::pow(0.14 * d.y, 2) +
                                        std::pow(0.14 * d.z, 2)));
      double reached = -1;
      for (int k = 0; k < rim.corners; ++k) reached = std::max(reached, Dot(rim.corner[k], d));
      EXPECT_LE(reached, support + 0.002);
      EXPECT_GE(reached, support - 0.012);
    }
  }
}

TEST(BodyTest, CentroidIsTheProjectedPositionInEveryPose) {
  Camera camera = PinholeCamera(60, 1280, 720);
  camera.intrinsics.distortion = {-0.2, 0.05, 0.001, -0.002};
  const Rigid3d cam_from_world = LookAt({0, -30, 1.7}, {0, 0, 10});
  int seen = 0;
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    Rng rng(17, trial);
    FlyingAnimal bird;
    bird.animal = {.id = 1, .wingspan = rng.Uniform(0.2, 2), .body_length = rng.Uniform(0.1, 0.8)};
    bird.position = {rng.Uniform(-12, 12), rng.Uniform(-25, 100), rng.Uniform(5, 20)};
    bird.world_from_body = WorldFromLevelBody({rng.Normal(), rng.Normal(), 0.5 * rng.Normal()});
    const auto body = ProjectBody(bird, rng.Uniform(0, 1), camera, cam_from_world);
    if (!body) continue;
    ++seen;
    const Vec3d in_cam = cam_from_world * bird.position;
    const Vec2d pixel = Project(camera.intrinsics, in_cam);
    EXPECT_EQ(body->center, pixel);
    EXPECT_EQ(body->depth, in_cam.z);
    const SilhouetteMoments m = MomentsOf(body->silhouette);
    EXPECT_NEAR(m.centroid.x, pixel.x, 1e-6);
    EXPECT_NEAR(m.centroid.y, pixel.y, 1e-6);
    // No larger than the animal can look, no smaller than a bird end-on.
    const double scale = camera.intrinsics.fx / in_cam.z;
    const double largest = std::max(bird.animal.wingspan, bird.animal.body_length) * scale;
    const Box box = BoundsOf(body->silhouette);
    EXPECT_LT(std::max(box.width, box.height), 1.35 * largest);
    EXPECT_GT(std::max(box.width, box.height), 0.15 * largest);
  }
  EXPECT_GT(seen, 100);
}

TEST(BodyTest, SeenFromBelowTheWingsSpanTheImage) {
  Camera camera = PinholeCamera(60, 1280, 720);
  FlyingAnimal bird;
  bird.animal = {.id = 1, .wingspan = 1, .body_length = 0.4, .wingbeat_hz = 0};
  bird.position = {0, 0, 50};
  bird.world_from_body = WorldFromLevelBody({1, 0, 0});  // the camera looks along world z
  const auto body = ProjectBody(bird, 0, camera, Rigid3d{});
  ASSERT_TRUE(body);
  const double scale = camera.intrinsics.fx / 50;
  const Box box = BoundsOf(body->silhouette);
  EXPECT_NEAR(box.height, 1.0 * scale, 1e-3 * scale);
  EXPECT_NEAR(box.width, 0.4 * scale, 0.02 * scale);
}

TEST(BodyTest, NothingBehindTheCameraFarOutsideOrFolded) {
  Camera camera = PinholeCamera(60, 1280, 720);
  FlyingAnimal bird;
  bird.animal = {.id = 1};
  for (const Vec3d& position : {Vec3d{0, 0, -10}, Vec3d{0, 0, 0.1}, Vec3d{1000, 0, 10}}) {
    bird.position = position;
    EXPECT_FALSE(ProjectBody(bird, 0, camera, Rigid3d{}));
  }
  bird.position = {0, 0, 20};
  EXPECT_TRUE(ProjectBody(bird, 0, camera, Rigid3d{}));
  // u = fx x (1 - x^2) turns back at x = 0.58: a point at x = 0.9 falls on the image of another.
  camera.intrinsics.distortion = {-1};
  bird.position = {18, 0, 20};
  EXPECT_FALSE(ProjectBody(bird, 0, camera, Rigid3d{}));
}

}  // namespace
}  // namespace flocklift
