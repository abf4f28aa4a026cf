// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/forces/shape_distance.h"

#include <gtest/gtest.h>

#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

static_assert(AgentTerm<ShapeDistance, float> && AgentTerm<ShapeDistance, double> &&
              AgentTerm<ShapeDistance, Pack> && AgentTerm<ShapeDistance, Jet>);

// in: gain, range, target, position.
struct Pull {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    return ShapeDistance::At(ShapeDistance::Params<T>{in[0], in[1], Vec3<T>{in[2], in[3], in[4]}},
                             Vec3<T>{in[5], in[6], in[7]}, Vec3<T>{});
  }
};

TEST(ShapeDistance, ProfileByHand) {
  EXPECT_EQ(ShapeDistance::Profile(0.0), 0);
  EXPECT_EQ(ShapeDistance::Profile(0.5), 0.5);
  EXPECT_EQ(ShapeDistance::Profile(0.75), 0.5625);
  EXPECT_EQ(ShapeDistance::Profile(1.0), 1);
  EXPECT_EQ(ShapeDistance::Profile(7.0), 1);
  for (double t = 0; t < 1; t += 0.01) {
    EXPECT_GE(ShapeDistance::Profile(t + 0.01), ShapeDistance::Profile(t));
  }
}

TEST(ShapeDistance, ByHand) {
  // 4 (s - x) / d f(d / D), with d = 1 and D = 2: half of 4.
  ExpectNear(Evaluate<double>(Pull{}, std::array{4.0, 2.0, 1.0, 2.0, 3.0, 1.0, 2.0, 2.0}),
             {0, 0, 2}, 1e-9);
  // Farther than D the pull is the whole of it.
  ExpectNear(Evaluate<double>(Pull{}, std::array{4.0, 2.0, 30.0, 40.0, 0.0, 0.0, 0.0, 0.0}),
             {2.4, 3.2, 0}, 1e-9);
  // There: no pull, and no division by nothing.
  EXPECT_NEAR(Norm(Evaluate<double>(Pull{}, std::array{4.0, 2.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0})), 0,
              1e-12);
}

TEST(ShapeDistance, ScalarsAgreeAndGradient) {
  for (const auto& in : {std::array{4.0, 2.0, 1.0, 2.0, 3.0, 0.5, 1.0, 2.5},
                         std::array{4.0, 2.0, 1.0, 2.0, 3.0, -5.0, 1.0, 2.5}}) {
    ExpectScalarsAgree(Pull{}, in);
    ExpectGradientMatches(Pull{}, in);
  }
}

}  // namespace
}  // namespace flocklift
