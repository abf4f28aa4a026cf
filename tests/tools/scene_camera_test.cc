// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/scene_camera.h"

#include <gtest/gtest.h>

#include "simulate/camera/projection.h"
#include "simulate/core/rigid3.h"

namespace flocklift {
namespace {

TEST(SceneCameraTest, StandsAsTheSceneSays) {
  Scene scene;
  scene.fps = 25;
  scene.camera.fov_deg = 60;
  scene.camera.width = 400;
  scene.camera.height = 300;
  scene.camera.position = {1, 2, 3};
  scene.camera.look_at = {4, 5, 6};
  const Camera camera = SceneCamera(scene);
  Camera expected = PinholeCamera(60, 400, 300);
  expected.fps = 25;
  expected.cam_from_world = LookAt({1, 2, 3}, {4, 5, 6});
  EXPECT_EQ(camera, expected);
}

// What was on the left edge is on the left edge again, with distortion too.
TEST(SceneCameraTest, AnotherSizeShowsTheSameView) {
  Camera camera = PinholeCamera(60, 401, 300);
  camera.intrinsics.cx += 7;
  camera.intrinsics.cy -= 3;
  camera.intrinsics.distortion = {-0.2, 0.05, 0.001, 0.002};
  const Camera small = Resized(camera, 100, 90);
  for (const Vec3d& point : {Vec3d{0.3, 0.2, 1}, Vec3d{-0.5, 0.1, 1}}) {
    const Vec2d before = Project(camera.intrinsics, point),
                after = Project(small.intrinsics, point);
    EXPECT_NEAR((after.x - 49.5) / 100, (before.x - 200) / 401, 1e-12);
    EXPECT_NEAR((after.y - 44.5) / 100, (before.y - 149.5) / 401, 1e-12);
  }
}

TEST(SceneCameraTest, APathHasAPoseForEachFrame) {
  Scene scene;
  scene.fps = 10;
  scene.duration = 3;
  scene.camera.path = {{0, {0, -20, 2}, {0, 0, 5}}, {2, {20, 0, 2}, {0, 0, 5}}};
  const Camera camera = SceneCamera(scene);
  ASSERT_EQ(camera.cam_from_world_per_frame.size(), 30U);
  EXPECT_TRUE(camera.KnowsGravity());
  EXPECT_EQ(camera.CamFromWorld(1), LookAt({0, -20, 2}, {0, 0, 5}));
  EXPECT_EQ(camera.CamFromWorld(30), LookAt({20, 0, 2}, {0, 0, 5}));
  EXPECT_NE(camera.CamFromWorld(11), camera.CamFromWorld(12));
}

}  // namespace
}  // namespace flocklift
