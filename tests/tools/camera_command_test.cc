// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/camera_command.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "simulate/camera/camera_io.h"
#include "simulate/camera/projection.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

class CameraCommandTest : public testing::Test {
 protected:
  CameraCommandTest() { fs::remove_all(folder_); }
  ~CameraCommandTest() override { fs::remove_all(folder_); }

  // `flocklift camera ARGUMENTS --out FOLDER --quiet`, and the file that it wrote.
  Camera Run(const std::string& arguments) {
    CLI::App app;
    AddCameraCommand(app);
    app.parse("camera " + arguments + " --quiet --out " + folder_.string());
    return ReadCamera(folder_ / "camera.yaml");
  }

  fs::path folder_ =
      fs::path(testing::TempDir()) / ("flocklift_camera_command_test_" + std::to_string(getpid()));
};

TEST_F(CameraCommandTest, StandsLevelAtEyeHeightByDefault) {
  const Camera camera = Run("--fov 90 --size 1000x500");
  EXPECT_EQ(camera.width, 1000);
  EXPECT_EQ(camera.height, 500);
  EXPECT_NEAR(camera.intrinsics.fx, 500, 1e-9);
  EXPECT_EQ(camera.intrinsics.fx, camera.intrinsics.fy);
  EXPECT_DOUBLE_EQ(camera.intrinsics.cx, 499.5);
  EXPECT_DOUBLE_EQ(camera.intrinsics.cy, 249.5);
  EXPECT_FALSE(camera.fps.has_value());
  ASSERT_TRUE(camera.KnowsGravity());
  // 10 m ahead and 1 m to the right at the height of the eyes; then 1 m above them.
  const Vec3d beside = *camera.cam_from_world * Vec3d{1, 10, 1.7};
  EXPECT_NEAR(beside.x, 1, 1e-12);
  EXPECT_NEAR(beside.y, 0, 1e-12);
  EXPECT_NEAR(beside.z, 10, 1e-12);
  EXPECT_NEAR((*camera.cam_from_world * Vec3d{0, 10, 2.7}).y, -1, 1e-12);
}

TEST_F(CameraCommandTest, PitchTurnsTheAxisAboveTheHorizon) {
  const Camera camera = Run("--fov 50 --size 1280x720 --pitch 30 --height 2 --fps 30000/1001");
  EXPECT_DOUBLE_EQ(*camera.fps, 30000.0 / 1001);
  const Vec3d ahead = *camera.cam_from_world * Vec3d{0, 10 * 0.8660254037844386, 2 + 5};
  EXPECT_NEAR(ahead.x, 0, 1e-9);
  EXPECT_NEAR(ahead.y, 0, 1e-9);
  EXPECT_NEAR(ahead.z, 10, 1e-9);
}

TEST_F(CameraCommandTest, LooksAtTheTarget) {
  const Camera camera = Run("--fov 40 --size 1920x1080 --position 3,-45,1.7 --look-at -2,0,12");
  const Vec2d pixel = Project(camera.intrinsics, *camera.cam_from_world * Vec3d{-2, 0, 12});
  EXPECT_NEAR(pixel.x, 959.5, 1e-9);
  EXPECT_NEAR(pixel.y, 539.5, 1e-9);
  const Vec3d eye = camera.cam_from_world->Inverse().translation;
  EXPECT_NEAR(eye.y, -45, 1e-9);
}

TEST_F(CameraCommandTest, RefusesWhatCannotBe) {
  for (const char* arguments :
       {"--size 10x10", "--fov 50", "--fov 180 --size 10x10", "--fov 0 --size 10x10",
        "--fov 50 --size 10", "--fov 50 --size 0x10", "--fov 50 --size 10x-10",
        "--fov 50 --size 10x10x10", "--fov 50 --size 10x10 --position 1,2 --look-at 0,0,1",
        "--fov 50 --size 10x10 --position 1,2,3", "--fov 50 --size 10x10 --look-at 1,2,3",
        "--fov 50 --size 10x10 --position 1,2,3,4 --look-at 0,0,1",
        "--fov 50 --size 10x10 --position 1,2,3 --look-at 0,0,1 --pitch 3",
        "--fov 50 --size 10x10 --fps 0", "--fov 50 --size 10x10 --pitch 91"}) {
    EXPECT_THROW(Run(arguments), CLI::ParseError) << arguments;
  }
  for (const char* arguments : {"--fov nan --size 10x10", "--fov 50 --size 10x10 --height nan",
                                "--fov 50 --size 10x10 --position 1,2,3 --look-at 1,2,3"}) {
    EXPECT_THROW(Run(arguments), std::invalid_argument) << arguments;
  }
  EXPECT_FALSE(fs::exists(folder_ / "camera.yaml"));
}

}  // namespace
}  // namespace flocklift
