// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/speck.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

Camera Looking(double fov, bool is_bent) {
  Camera camera = PinholeCamera(fov, 640, 480);
  camera.cam_from_world = LookAt({0, -45, 1.7}, {0, 0, 12});
  if (is_bent) camera.intrinsics.distortion = {-0.25, 0.08, 0.001, -0.001};
  return camera;
}

FlyingAnimal Random(std::uint64_t trial, const Camera& camera, double size_px) {
  Rng rng(21, trial);
  FlyingAnimal flying;
  const double depth = rng.Uniform(5, 80);
  flying.animal.wingspan = size_px * depth / camera.intrinsics.fx;
  flying.animal.body_length = flying.animal.wingspan * rng.Uniform(0.3, 1);
  flying.animal.wingbeat_phase = rng.Uniform(0, 6.28);
  if (trial % 5 == 0) flying.animal.wingbeat_hz = 0;
  const double x = (rng.Uniform(20, 620) - camera.intrinsics.cx) / camera.intrinsics.fx;
  const double y = (rng.Uniform(20, 460) - camera.intrinsics.cy) / camera.intrinsics.fy;
  flying.position = camera.CamFromWorld(1).Inverse() * (depth * Vec3d{x, y, 1});
  const double w = rng.Normal(), i = rng.Normal(), j = rng.Normal(), k = rng.Normal();
  const double norm = std::sqrt(w * w + i * i + j * j + k * k);
  flying.world_from_body = RotationFromQuaternion({w / norm, i / norm, j / norm, k / norm});
  return flying;
}

TEST(SpeckTest, HasTheAreaOfTheSilhouette) {
  const SpeckAreas areas;
  for (const bool is_bent : {false, true}) {
    const Camera camera = Looking(60, is_bent);
    double error = 0, bias = 0, total = 0;
    int seen = 0;
    for (std::uint64_t trial = 0; trial < 1500; ++trial) {
      const FlyingAnimal flying = Random(trial, camera, 1);
      const auto exact = ProjectBody(flying, 0.3, camera, camera.CamFromWorld(1));
      const auto speck = ProjectSpeck(flying, 0.3, 0, areas, camera, camera.CamFromWorld(1));
      if (!exact) continue;  // outside the image
      ASSERT_TRUE(speck);
      const double area = MomentsOf(exact->silhouette).area;
      EXPECT_NEAR(speck->area, area, 0.02) << trial;  // [px^2]
      EXPECT_NEAR(speck->from.x, exact->center.x, 1e-9);
      EXPECT_NEAR(speck->to.y, exact->center.y, 1e-9);
      EXPECT_NEAR(speck->depth, exact->depth, 1e-9);
      error += std::abs(speck->area - area);
      bias += speck->area - area;
      total += area;
      ++seen;
    }
    EXPECT_GT(seen, 1000);
    EXPECT_LT(error / total, 0.01);
    EXPECT_LT(std::abs(bias) / total, 0.005);
    RecordProperty(is_bent ? "error_bent" : "error", std::to_string(error / total));
  }
}

Vec2d HalfExtent(const ProjectedBody& body) {
  const Box box = BoundsOf(body.silhouette);
  return {0.5 * box.width, 0.5 * box.height};
}

TEST(SpeckTest, HasTheBoxAndTheMomentsOfTheSilhouette) {
  const SpeckAreas areas;
  for (const bool is_bent : {false, true}) {
    const Camera camera = Looking(60, is_bent);
    const Rigid3d cam_from_world = camera.CamFromWorld(1);
    double box_error = 0, moment_error = 0;
    int seen = 0;
    for (std::uint64_t trial = 0; trial < 1500; ++trial) {
      const FlyingAnimal flying = Random(trial, camera, kSpeckPx);
      const auto exact = ProjectBody(flying, 0.3, camera, cam_from_world);
      const auto speck = ProjectSpeckBox(flying, 0.3, areas, camera, cam_from_world);
      const auto streak = ProjectSpeck(flying, 0.3, 0, areas, camera, cam_from_world);
      if (!exact) continue;  // outside the image
      ASSERT_TRUE(speck && streak);
      const Vec2d extent = HalfExtent(*exact);
      EXPECT_NEAR(speck->half_width, extent.x, 0.08) << trial;  // [px]
      EXPECT_NEAR(speck->half_height, extent.y, 0.08) << trial;
      EXPECT_NEAR(speck->moments.xx, exact->moments.xx, 0.01) << trial;  // [px^2]
      EXPECT_NEAR(speck->moments.xy, exact->moments.xy, 0.01) << trial;
      EXPECT_NEAR(speck->moments.yy, exact->moments.yy, 0.01) << trial;
      EXPECT_NEAR(speck->moments.area, streak->area, 1e-3 * streak->area) << trial;
      EXPECT_NEAR(speck->moments.centroid.x, exact->center.x, 1e-9);
      EXPECT_NEAR(speck->depth, exact->depth, 1e-9);
      box_error += std::abs(speck->half_width - extent.x) + std::abs(speck->half_height - extent.y);
      moment_error += std::abs(speck->moments.xx - exact->moments.xx) +
                      std::abs(speck->moments.yy - exact->moments.yy);
      ++seen;
    }
    EXPECT_GT(seen, 1000);
    EXPECT_LT(box_error / (2 * seen), 0.01);      // [px]
    EXPECT_LT(moment_error / (2 * seen), 0.001);  // [px^2]
    RecordProperty(is_bent ? "box_error_bent" : "box_error",
                   std::to_string(box_error / (2 * seen)));
  }
}

TEST(SpeckTest, TablesAreWithinAHundredthOfTheSizeOnAverage) {
  const SpeckAreas areas;
  const Camera camera = Looking(60, false);
  double width = 0, height = 0, spread = 0;
  int seen = 0;
  for (std::uint64_t trial = 0; trial < 1500; ++trial) {
    const FlyingAnimal flying = Random(trial, camera, kTablePx);
    const auto exact = ProjectBody(flying, 0.3, camera, camera.CamFromWorld(1));
    const auto speck = ProjectSpeckBox(flying, 0.3, areas, camera, camera.CamFromWorld(1));
    if (!exact) continue;  // outside the image
    ASSERT_TRUE(speck);
    width += std::abs(speck->half_width - HalfExtent(*exact).x);
    height += std::abs(speck->half_height - HalfExtent(*exact).y);
    spread += std::abs(ShapeOf(speck->moments).major - ShapeOf(exact->moments).major);
    ++seen;
  }
  EXPECT_GT(seen, 1000);
  EXPECT_LT(2 * width / seen, 0.01 * kTablePx);  // of the whole box
  EXPECT_LT(2 * height / seen, 0.01 * kTablePx);
  EXPECT_LT(spread / seen, 0.01 * kTablePx);
}

TEST(SpeckTest, LiesAlongTheWayOfTheAnimal) {
  const Camera camera = Looking(60, false);
  const SpeckAreas areas;
  FlyingAnimal flying = Random(3, camera, 1);
  const Vec3d velocity_in_cam{3, -4, 0};
  flying.velocity = camera.CamFromWorld(1).rotation.Inverse() * velocity_in_cam;
  const auto speck = ProjectSpeck(flying, 0, 0.01, areas, camera, camera.CamFromWorld(1));
  ASSERT_TRUE(speck);
  const double px = 0.01 * camera.intrinsics.fx / speck->depth;
  EXPECT_NEAR(speck->to.x - speck->from.x, 3 * px, 1e-9);
  EXPECT_NEAR(speck->to.y - speck->from.y, -4 * px, 1e-9);
}

TEST(SpeckTest, WhatIsBehindOrBesideIsNotSeen) {
  const Camera camera = PinholeCamera(60, 640, 480);
  const SpeckAreas areas;
  FlyingAnimal flying;
  for (const Vec3d& position : {Vec3d{0, 0, -5}, Vec3d{40, 0, 5}, Vec3d{0, -40, 5}}) {
    flying.position = position;
    EXPECT_FALSE(ProjectSpeck(flying, 0, 0, areas, camera, {}));
  }
  Camera folding = camera;
  folding.intrinsics.distortion = {-0.3, 0, 0, 0};
  flying.position = {8, 0, 5};
  EXPECT_FALSE(ProjectSpeck(flying, 0, 0, areas, folding, {}));
}

TEST(SpeckTest, TablesAreTheSameFromAnyThread) {
  const SpeckAreas areas, alone;
  const Animal animal{.id = 1, .wingspan = 0.01, .body_length = 0.006};
  std::vector<double> found(4);
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < found.size(); ++k) {
    threads.emplace_back([&, k] { found[k] = areas.Area(animal, 0.1, {0.6, 0, 0.8}); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const double area : found) EXPECT_EQ(area, alone.Area(animal, 0.1, {0.6, 0, 0.8}));
}

}  // namespace
}  // namespace flocklift
