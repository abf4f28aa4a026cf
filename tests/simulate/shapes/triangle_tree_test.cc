// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/triangle_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulate/core/rng.h"
#include "tests/simulate/shapes/block_letter.h"

namespace flocklift {
namespace {

Vec3d RandomPoint(Rng* rng, double reach) {
  return {rng->Uniform(-reach, reach), rng->Uniform(-reach, reach), rng->Uniform(-reach, reach)};
}

TEST(TriangleTree, NearestPointEqualsBruteForce) {
  const TriangleMesh ball = Ball(1, 12);
  const TriangleTree tree(ball);
  Rng rng(3);
  for (int k = 0; k < 300; ++k) {
    const Vec3d p = RandomPoint(&rng, 2);
    double best = 1e9;
    for (std::size_t t = 0; t < ball.triangles.size(); ++t) {
      best =
          std::min(best, SquaredNorm(p - NearestOnTriangle(p, ball.Corner(t, 0), ball.Corner(t, 1),
                                                           ball.Corner(t, 2))));
    }
    const TriangleTree::Nearest found = tree.NearestPoint(p);
    EXPECT_EQ(found.squared_distance, best);
    EXPECT_NEAR(SquaredNorm(found.point - p), best, 1e-12);
  }
}

TEST(NearestOnTriangle, NoOtherPointOfTheTriangleIsNearer) {
  Rng rng(4);
  for (int k = 0; k < 100; ++k) {
    const Vec3d a = RandomPoint(&rng, 1), b = RandomPoint(&rng, 1), c = RandomPoint(&rng, 1);
    const Vec3d p = RandomPoint(&rng, 2);
    const double nearest = Norm(p - NearestOnTriangle(p, a, b, c));
    double sampled = 1e9;
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; i + j <= 40; ++j) {
        sampled = std::min(sampled, Norm(p - (a + i / 40.0 * (b - a) + j / 40.0 * (c - a))));
      }
    }
    EXPECT_LE(nearest, sampled + 1e-12);
    EXPECT_GE(nearest, sampled - 0.1);
  }
}

TEST(TriangleTree, SegmentsMeetABoxWhereTheyMust) {
  const TriangleTree box(BlockLetter({{0, 0}}, 1));
  const auto hit = box.FirstHit({0.3, 0.4, -1}, {0.3, 0.4, 3});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(*hit, 0.25, 1e-12);  // at the bottom, before the top
  EXPECT_FALSE(box.FirstHit({0.3, 0.4, 0.2}, {0.5, 0.6, 0.8}));
  EXPECT_FALSE(box.FirstHit({2, 2, 2}, {3, 3, 3}));
  ASSERT_TRUE(box.FirstHit({0.5, 0.5, 0.5}, {0.5, 2.5, 0.5}));
  EXPECT_NEAR(*box.FirstHit({0.5, 0.5, 0.5}, {0.5, 2.5, 0.5}), 0.25, 1e-12);
}

TEST(TriangleTree, NeedsTriangles) { EXPECT_THROW(TriangleTree({}), std::invalid_argument); }

}  // namespace
}  // namespace flocklift
