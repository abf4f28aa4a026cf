// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/target_region.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

// Tetrahedra along the diagonal from (0, 0, 0) to (10, 10, 0): long and thin.
std::vector<Tetra> Rod() {
  std::vector<Tetra> rod;
  for (int k = 0; k <= 40; ++k) {
    const Vec3d p{k * 0.25, k * 0.25, 0};
    rod.push_back({p, p + Vec3d{0.2, 0, 0}, p + Vec3d{0, 0.2, 0}, p + Vec3d{0, 0, 0.2}});
  }
  return rod;
}

TEST(SmallestSphere, OfACubesCornersAndOfTwoPoints) {
  std::vector<Vec3d> cube;
  for (int k = 0; k < 8; ++k) cube.push_back({double(k & 1), double(k >> 1 & 1), double(k >> 2)});
  const BoundingSphere sphere = SmallestSphere(cube);
  EXPECT_NEAR(Norm(sphere.centre - Vec3d{0.5, 0.5, 0.5}), 0, 1e-9);
  EXPECT_NEAR(sphere.radius, std::sqrt(3.0) / 2, 1e-9);
  const std::vector<Vec3d> two{{1, 0, 0}, {5, 0, 0}};
  EXPECT_NEAR(SmallestSphere(two).radius, 2, 1e-9);
}

// Optimal: it holds all points, and its centre lies in the hull of those on it, that is, no
// direction has all of them on the far side.
TEST(SmallestSphere, HoldsAllAndCannotBeSmaller) {
  Rng rng(31);
  for (int round = 0; round < 20; ++round) {
    std::vector<Vec3d> points;
    for (int k = 0; k < 200; ++k) points.push_back({rng.Normal(), 2 * rng.Normal(), rng.Normal()});
    const BoundingSphere sphere = SmallestSphere(points);
    std::vector<Vec3d> rim;
    for (const Vec3d& p : points) {
      EXPECT_LE(Norm(p - sphere.centre), sphere.radius * (1 + 1e-9));
      if (Norm(p - sphere.centre) > sphere.radius * (1 - 1e-7)) rim.push_back(p - sphere.centre);
    }
    ASSERT_GE(rim.size(), 2u);
    for (int k = 0; k < 500; ++k) {
      const Vec3d way = Normalized({rng.Normal(), rng.Normal(), rng.Normal()});
      double farthest = -1;
      for (const Vec3d& r : rim) farthest = std::max(farthest, Dot(way, r));
      EXPECT_GE(farthest, -1e-6);
    }
  }
}

TEST(TargetRegion, AllKindsHoldTheTarget) {
  const std::vector<Tetra> rod = Rod();
  for (const RegionKind kind : {RegionKind::kSphere, RegionKind::kBox, RegionKind::kShape}) {
    const TargetRegion region(kind, rod, 0.3);
    for (const Tetra& t : rod) {
      EXPECT_TRUE(region.Contains(Centroid(t)));
      EXPECT_LE(Norm(Centroid(t) - region.sphere().centre), region.sphere().radius);
    }
    EXPECT_FALSE(region.Contains({20, 20, 20}));
  }
}

TEST(TargetRegion, ASphereIsMostlyEmptyAboutARod) {
  const std::vector<Tetra> rod = Rod();
  const Vec3d beside{7, 3, 0};  // 2.8 m from the rod
  EXPECT_TRUE(TargetRegion(RegionKind::kSphere, rod, 0.3).Contains(beside));
  EXPECT_FALSE(TargetRegion(RegionKind::kBox, rod, 0.3).Contains(beside));
  EXPECT_FALSE(TargetRegion(RegionKind::kShape, rod, 0.3).Contains(beside));
}

TEST(TargetRegion, AShapeReachesAsFarAsTheMargin) {
  const std::vector<Tetra> rod = Rod();
  const double margin = 0.6, slack = 0.3;  // cells, and the balls about the tetrahedra
  const TargetRegion region(RegionKind::kShape, rod, margin);
  const Vec3d across = Normalized({1, -1, 0}), on{5, 5, 0};
  EXPECT_TRUE(region.Contains(on + (margin - 0.05) * across));
  EXPECT_FALSE(region.Contains(on + (margin + 0.2 + slack) * across));
}

TEST(TargetRegion, RefusesNothing) {
  EXPECT_THROW(TargetRegion(RegionKind::kSphere, {}, 1), std::invalid_argument);
  EXPECT_THROW(TargetRegion(RegionKind::kShape, Rod(), 0), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
