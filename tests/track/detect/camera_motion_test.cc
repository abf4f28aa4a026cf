// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/camera_motion.h"

#include <gtest/gtest.h>

#include "tests/track/pictures.h"

namespace flocklift {
namespace {

constexpr int kWidth = 480, kHeight = 320;

// A ridge of soft rocks along the bottom, as a camera sees it that stands at `image_from_world`;
// `birds` fly before it.
GrayImage Ridge(const Similarity& image_from_world, double noise, std::uint64_t seed,
                std::vector<SoftBlob> birds = {}) {
  Rng rng(3);
  for (int k = 0; k < 150; ++k) {
    const Vec2d p{rng.Uniform(-20, kWidth + 20), rng.Uniform(200, kHeight + 20)};
    birds.push_back({.center = image_from_world * p,
                     .contrast = rng.Uniform(-60, 60),
                     .major_sd = 3,
                     .minor_sd = 3});
  }
  return DrawPicture(kWidth, kHeight, {.level = 150, .noise = noise}, birds, seed);
}

Similarity Camera(double degrees, double tx, double ty) {
  const double angle = degrees * std::numbers::pi / 180;
  return {std::cos(angle), std::sin(angle), tx, ty};
}

TEST(SimilarityTest, InverseAndProduct) {
  const Similarity m{1.1, 0.2, 5, -3}, n{0.9, -0.1, 2, 7};
  const Vec2d p{13, 21};
  const Vec2d back = m.Inverse() * (m * p), both = (m * n) * p, one_by_one = m * (n * p);
  EXPECT_NEAR(back.x, p.x, 1e-12);
  EXPECT_NEAR(back.y, p.y, 1e-12);
  EXPECT_NEAR(both.x, one_by_one.x, 1e-12);
  EXPECT_NEAR(both.y, one_by_one.y, 1e-12);
}

TEST(CameraMotionTest, FindsShiftAndRotation) {
  const Similarity truth = Camera(0.4, 2.3, -1.6);
  const auto found = MotionBetween(Ridge({}, 1, 1), {}, Ridge(truth, 1, 2));
  ASSERT_TRUE(found);
  for (const Vec2d p : {Vec2d{0, 0}, Vec2d{480, 0}, Vec2d{240, 320}}) {
    const Vec2d is = *found * p, wanted = truth * p;
    EXPECT_NEAR(is.x, wanted.x, 0.3);
    EXPECT_NEAR(is.y, wanted.y, 0.3);
  }
}

// A sky without texture, and birds that fly to the right: the camera does not.
TEST(CameraMotionTest, AnEmptySkySaysNothing) {
  std::vector<SoftBlob> before, after;
  for (int k = 0; k < 20; ++k) {
    const Vec2d p{30.0 + 22 * k, 60.0 + 37 * (k % 5)};
    before.push_back({.center = p});
    after.push_back({.center = {p.x + 3, p.y}});
  }
  const GrayImage a = DrawPicture(kWidth, kHeight, {.level = 150, .noise = 2}, before, 1);
  const GrayImage b = DrawPicture(kWidth, kHeight, {.level = 150, .noise = 2}, after, 2);
  EXPECT_FALSE(MotionBetween(a, BlobsOf(1, before), b));
}

TEST(CameraMotionTest, AutoNoticesAShakyCameraAndFollowsIt) {
  CameraMotion motion({});
  Similarity last;
  Similarity truth_then;
  bool was_moving = false;
  for (int frame = 0; frame < 40; ++frame) {
    const Similarity truth =
        Camera(0.2 * std::sin(0.9 * frame), 3 * std::sin(0.8 * frame), 2 * std::cos(0.7 * frame));
    last = motion.Next(Ridge(truth, 1, static_cast<std::uint64_t>(frame)), {});
    if (!was_moving) truth_then = truth;  // the world is the picture from which it was followed
    was_moving = motion.moves();
    if (!was_moving) {
      EXPECT_TRUE(last.IsIdentity());
      continue;
    }
    // A rock in the picture now, and in the world.
    const Vec2d rock{200, 250};
    const Vec2d world = last * (truth * rock), then = truth_then * rock;
    EXPECT_NEAR(world.x, then.x, 1.0) << frame;
    EXPECT_NEAR(world.y, then.y, 1.0) << frame;
  }
  EXPECT_TRUE(was_moving);
}

TEST(CameraMotionTest, AutoLeavesARestingCameraAlone) {
  CameraMotion motion({});
  for (int frame = 0; frame < 40; ++frame) {
    EXPECT_TRUE(motion.Next(Ridge({}, 2, static_cast<std::uint64_t>(frame)), {}).IsIdentity());
  }
  EXPECT_FALSE(motion.moves());
  EXPECT_THROW(CameraMotion({.camera = "flies"}), std::invalid_argument);
}

TEST(CameraMotionTest, AutoNoticesACameraThatRestedForLong) {
  CameraMotion motion({});
  const GrayImage resting = Ridge({}, 1, 1);
  for (int frame = 0; frame < 260; ++frame) motion.Next(resting, {});
  EXPECT_FALSE(motion.moves());
  const GrayImage shifted = Ridge(Camera(0, 3, 0), 1, 2);
  for (int frame = 0; frame < 80; ++frame) motion.Next(frame % 2 == 0 ? shifted : resting, {});
  EXPECT_TRUE(motion.moves());
}

}  // namespace
}  // namespace flocklift
