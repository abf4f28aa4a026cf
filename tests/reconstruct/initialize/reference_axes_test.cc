// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/reference_axes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace flocklift {
namespace {

// Pans by so many degrees a frame while it walks east and rises.
Camera Panning(double degrees, int frames) {
  Camera camera = PinholeCamera(50, 1920, 1080);
  for (int k = 0; k < frames; ++k) {
    const double angle = degrees * k * std::numbers::pi / 180;
    const Vec3d place{0.2 * k, -40, 2 + 0.05 * k};
    camera.cam_from_world_per_frame.push_back(
        LookAt(place, place + Vec3d{std::sin(angle), std::cos(angle), 0.3}));
  }
  return camera;
}

TEST(ReferenceAxes, AreTheCamerasOwnWhereItStands) {
  Camera camera = PinholeCamera(50, 1920, 1080);
  camera.cam_from_world = LookAt({1, -30, 2}, {3, 0, 9});
  const ReferenceAxes axes(camera, 5, 9);
  EXPECT_EQ(axes.ref_from_world(), camera.cam_from_world->rotation);
  EXPECT_FALSE(axes.moves());
  EXPECT_EQ(axes.Turn(7, {0.3, -0.2})->ray, (Vec2d{0.3, -0.2}));
  EXPECT_EQ(axes.DepthInCam(7, {1, 2, 30}), 30);
  EXPECT_EQ(axes.CameraPlace(9), Vec3d{});
}

// A point in the world: its ray turned into the reference axes is the ray of the point there, and
// its depth in the camera comes back.
TEST(ReferenceAxes, TurnedRaysMeetThePoint) {
  const Camera camera = Panning(0.5, 60);
  const ReferenceAxes axes(camera, 1, 60);
  EXPECT_TRUE(axes.moves());
  const Vec3d point{12, 3, 20};
  for (const int frame : {1, 30, 60}) {
    const Vec3d in_cam = camera.CamFromWorld(frame) * point;
    const Vec3d in_ref = axes.RefFromWorld(frame) * point;
    const auto turned = axes.Turn(frame, {in_cam.x / in_cam.z, in_cam.y / in_cam.z});
    ASSERT_TRUE(turned);
    EXPECT_NEAR(turned->ray.x, in_ref.x / in_ref.z, 1e-12);
    EXPECT_NEAR(turned->ray.y, in_ref.y / in_ref.z, 1e-12);
    EXPECT_NEAR(axes.DepthInCam(frame, in_ref), in_cam.z, 1e-12);
    EXPECT_LT(Norm(axes.WorldFromRef(frame) * in_ref - point), 1e-12);
  }
  const Vec3d moved = axes.WorldFromRef(60).translation - axes.WorldFromRef(1).translation;
  EXPECT_LT(Norm(axes.ref_from_world().Inverse() * axes.CameraPlace(60) - moved), 1e-12);
}

// The magnification is the root of the area that a small square of rays covers after the turn.
TEST(ReferenceAxes, MagnificationIsTheRootOfTheArea) {
  const Camera camera = Panning(0.8, 60);
  const ReferenceAxes axes(camera, 1, 60);
  const Vec2d ray{0.2, -0.1};
  const double h = 1e-5;
  const Vec2d a = axes.Turn(1, ray)->ray, b = axes.Turn(1, {ray.x + h, ray.y})->ray,
              c = axes.Turn(1, {ray.x, ray.y + h})->ray;
  const double area = ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / (h * h);
  EXPECT_NEAR(axes.Turn(1, ray)->magnification, std::sqrt(area), 1e-4);
  EXPECT_GT(std::abs(axes.Turn(1, {-0.3, 0})->magnification - 1), 0.2);
}

TEST(ReferenceAxes, RaysFarBesideAreNone) {
  const Camera camera = Panning(2, 60);  // 59 degrees to either side of the mean
  const ReferenceAxes axes(camera, 1, 60);
  EXPECT_TRUE(axes.Turn(1, {0.4, 0}));
  EXPECT_FALSE(axes.Turn(1, {-0.4, 0}));
}

TEST(ReferenceAxes, LookingAllAroundIsRefused) {
  const Camera camera = Panning(6, 60);
  EXPECT_THROW(ReferenceAxes(camera, 1, 60), std::invalid_argument);
  EXPECT_THROW(ReferenceAxes(camera, 1, 61), std::invalid_argument);  // a pose is missing
}

}  // namespace
}  // namespace flocklift
