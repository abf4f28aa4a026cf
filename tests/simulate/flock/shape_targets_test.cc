// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/shape_targets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/shapes/solid_meshes.h"

namespace flocklift {
namespace {

constexpr int kCount = 200;

std::vector<Vec3d> Start(const Vec3d& center, int count = kCount) {
  std::vector<Vec3d> points;
  Rng rng(3);
  for (int k = 0; k < count; ++k) {
    points.push_back(center + Vec3d{rng.Normal(), rng.Normal(), rng.Normal()});
  }
  return points;
}

TriangleMesh Scaled(TriangleMesh mesh, double factor) {
  for (Vec3d& v : mesh.vertices) v = factor * v;
  return mesh;
}

TEST(ShapeTargets, EveryAnimalHasAPlaceOfItsOwnOnTheSurface) {
  const ShapeInTime shape{"ball", {0}, {BallMesh({1, 2, 3}, 2, 3)}, 0, ""};
  ThreadPool pool(2);
  ShapeTargets targets(shape, nullptr, 10, Start({}), 0, 1, 1);
  const std::vector<Vec3d> at = targets.At(0, &pool);
  ASSERT_EQ(at.size(), static_cast<std::size_t>(kCount));
  EXPECT_NEAR(targets.MeanDistanceToSurface(at, 0), 0, 1e-9);
  EXPECT_NEAR(targets.Spacing(0), std::sqrt(16 * std::numbers::pi / kCount), 0.01);
  for (std::size_t i = 0; i < at.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_GT(Norm(at[i] - at[j]), 0.4 * targets.Spacing(0));
  }
  EXPECT_EQ(targets.At(7, &pool), at);
  EXPECT_EQ(targets.Velocity(3), (Vec3d{}));
}

TEST(ShapeTargets, OfAnAnimationMoveWithTheMeshAndComeRound) {
  const TriangleMesh ball = BallMesh({}, 1, 3);
  const ShapeInTime shape{"breath", {0, 1}, {ball, Scaled(ball, 3)}, 4, ""};
  ThreadPool pool(2);
  ShapeTargets targets(shape, nullptr, 10, Start({}), 0, 1, 1);
  const std::vector<Vec3d> first = targets.At(0, &pool);
  const auto expect_scale = [&](double time, double scale) {
    const std::vector<Vec3d> now = targets.At(time, &pool);
    for (std::size_t k = 0; k < now.size(); ++k) {
      EXPECT_NEAR(Norm(now[k] - scale * first[k]), 0, 1e-9) << time;
    }
  };
  expect_scale(0.5, 2);  // half-way to the second key-frame,
  expect_scale(1, 3);
  expect_scale(2.5, 2);  // ... and half-way back, which takes the rest of the period
  expect_scale(4, 1);
  expect_scale(8.5, 2);
}

TEST(ShapeTargets, OfShapesInTurnPassOverToNearOnes) {
  const ShapeInTime shape{
      "two", {0, 5}, {BallMesh({}, 1, 3), BoxMesh({-1, -1, -1}, {1, 1, 1})}, 0, ""};
  ThreadPool pool(2);
  ShapeTargets targets(shape, nullptr, 10, Start({}), 0, 1, 1);
  const std::vector<Vec3d> before = targets.At(4.9, &pool), after = targets.At(5, &pool);
  EXPECT_EQ(targets.At(0, &pool), before);
  EXPECT_EQ(targets.At(99, &pool), after);
  double mean = 0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    EXPECT_NEAR(Norm(before[k]), 1, 0.02);
    const Vec3d p = after[k];
    EXPECT_NEAR(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 1, 1e-9);
    mean += Norm(after[k] - before[k]) / kCount;
  }
  EXPECT_LT(mean, 0.5);  // the ball touches the box from inside
}

TEST(ShapeTargets, OnAPathTheyMoveAtItsSpeed) {
  const ShapeInTime shape{"ball", {0}, {BallMesh({}, 1, 2)}, 0, "way"};
  const PathSpec path{"way", {{0, 0, 5}, {30, 0, 5}}, 2, 0};
  ThreadPool pool(2);
  ShapeTargets targets(shape, &path, 10, Start({}), 0, 1, 1);
  const std::vector<Vec3d> first = targets.At(0, &pool), later = targets.At(3, &pool);
  for (std::size_t k = 0; k < first.size(); ++k) {
    EXPECT_NEAR(Norm(later[k] - first[k] - Vec3d{6, 0, 0}), 0, 1e-6);
  }
  EXPECT_NEAR(Norm(targets.Velocity(3) - Vec3d{2, 0, 0}), 0, 1e-6);
  EXPECT_EQ(targets.Velocity(16), (Vec3d{}));  // it has arrived
  EXPECT_NEAR(targets.MeanDistanceToSurface({{6, 0, 5}}, 3), 1, 0.07);
  // Without a speed of its own a path takes the scene's duration.
  const PathSpec slow{"way", {{0, 0, 5}, {30, 0, 5}}, 0, 0};
  ShapeTargets with_duration(shape, &slow, 10, Start({}), 0, 1, 1);
  EXPECT_NEAR(with_duration.Velocity(1).x, 3, 1e-6);
}

TEST(ShapeTargets, SameAtAnyNumberOfThreads) {
  const ShapeInTime shape{"ball", {0}, {BallMesh({}, 1, 3)}, 0, ""};
  const std::vector<Vec3d> start = Start({}, 2500);  // more than one thread takes at once
  ShapeTargets one(shape, nullptr, 10, start, 0, 1, 1), two(shape, nullptr, 10, start, 0, 1, 2);
  ThreadPool single(1), pair(2);
  EXPECT_EQ(one.At(0, &single), two.At(0, &pair));
}

}  // namespace
}  // namespace flocklift
