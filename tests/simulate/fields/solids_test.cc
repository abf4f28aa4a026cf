// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/solids.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

TEST(Solids, ByHand) {
  const Ball ball{{1, 0, 0}, 2};
  EXPECT_DOUBLE_EQ(ball({1, 0, 0}), -2);
  EXPECT_DOUBLE_EQ(ball({1, 3, 4}), 3);
  const Block block{{0, 0, 0}, {2, 4, 6}};
  EXPECT_DOUBLE_EQ(block({1, 2, 3}), -1);
  EXPECT_DOUBLE_EQ(block({5, 8, 3}), 5);
  EXPECT_DOUBLE_EQ(block({3, 4, 6}), 1);
  const Capsule capsule{{0, 0, 0}, {0, 0, 2}, 0.5};
  EXPECT_DOUBLE_EQ(capsule({0, 0, 1}), -0.5);
  EXPECT_DOUBLE_EQ(capsule({2, 0, 1}), 1.5);
  EXPECT_DOUBLE_EQ(capsule({3, 0, 6}), 4.5);
  EXPECT_DOUBLE_EQ((Capsule{{1, 1, 1}, {1, 1, 1}, 1}({1, 4, 5})), 4);  // a ball
  const Cylinder column{{0, 0, 0}, {0, 0, 4}, 1};
  EXPECT_DOUBLE_EQ(column({0, 0, 2}), -1);
  EXPECT_DOUBLE_EQ(column({0.5, 0, 3.75}), -0.25);
  EXPECT_DOUBLE_EQ(column({3, 0, 1}), 2);
  EXPECT_DOUBLE_EQ(column({0.2, 0.3, 7}), 3);
  EXPECT_DOUBLE_EQ(column({4, 0, 8}), 5);  // beyond the rim
}

// An exact distance grows by no more than the way, and along its gradient by just that.
TEST(Solids, TheSlopeIsOne) {
  const std::vector<Solid> solids = {Ball{{0.2, 0.1, 0}, 0.8}, Block{{-1, -0.5, -0.3}, {0.7, 1, 1}},
                                     Capsule{{-0.5, 0, 0.2}, {0.6, 0.4, -0.4}, 0.4},
                                     Cylinder{{-0.5, 0, 0.2}, {0.6, 0.4, -0.4}, 0.6}};
  Rng rng(2);
  for (const Solid& solid : solids) {
    int inside = 0;
    for (int k = 0; k < 500; ++k) {
      const Vec3d p{rng.Uniform(-2, 2), rng.Uniform(-2, 2), rng.Uniform(-2, 2)};
      const double h = 1e-6, here = SignedDistance(solid, p);
      inside += here < 0;
      const Vec3d slope =
          Vec3d{
              SignedDistance(solid, p + Vec3d{h, 0, 0}) - SignedDistance(solid, p - Vec3d{h, 0, 0}),
              SignedDistance(solid, p + Vec3d{0, h, 0}) - SignedDistance(solid, p - Vec3d{0, h, 0}),
              SignedDistance(solid, p + Vec3d{0, 0, h}) -
                  SignedDistance(solid, p - Vec3d{0, 0, h})} /
          (2 * h);
      EXPECT_NEAR(Norm(slope), 1, 1e-5) << solid.index();
      // The foot that gradient and distance point to lies on the surface.
      EXPECT_NEAR(SignedDistance(solid, p - here * slope), 0, 1e-5) << solid.index();
    }
    EXPECT_GT(inside, 5) << solid.index();
  }
}

TEST(Solids, AUnionIsItsNearestPart) {
  const std::vector<Solid> solids = {Ball{{0, 0, 0}, 1}, Ball{{4, 0, 0}, 2}};
  EXPECT_DOUBLE_EQ(SignedDistance(solids, {1.5, 0, 0}), 0.5);
  EXPECT_DOUBLE_EQ(SignedDistance(solids, {4.5, 0, 0}), -1.5);
  EXPECT_EQ(SignedDistance(std::span<const Solid>(), {0, 0, 0}),
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace flocklift
