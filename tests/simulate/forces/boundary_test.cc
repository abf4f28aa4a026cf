// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/forces/boundary.h"

#include <gtest/gtest.h>

#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

// in: gain, taper, position; walls at -1..4, -2..5, 0..6.
struct Walls {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    const Boundary::Params<T> p{in[0], {T(-1.0), T(-2.0), T(0.0)}, {T(4.0), T(5.0), T(6.0)}, in[1]};
    return Boundary::At(p, Vec3<T>{in[2], in[3], in[4]}, Vec3<T>{});
  }
};

TEST(Boundary, ByHand) {
  const auto at = [](double x, double y, double z) {
    return Evaluate<double>(Walls{}, std::array{0.5, 0.0, x, y, z});
  };
  EXPECT_EQ(at(0, 0, 3), (Vec3d{}));
  EXPECT_EQ(at(-1.01, 0, 3), (Vec3d{0.5, 0, 0}));
  EXPECT_EQ(at(4.01, 5.01, -0.01), (Vec3d{-0.5, -0.5, 0.5}));
  EXPECT_EQ(at(-1, 5, 6), (Vec3d{}));  // on the wall is inside
}

TEST(Boundary, SoftWallPushesHalfOnTheWall) {
  const Vec3d push = Evaluate<double>(Walls{}, std::array{0.5, 1.0, -1.0, 5.25, 3.0});
  EXPECT_DOUBLE_EQ(push.x, 0.25);
  EXPECT_DOUBLE_EQ(push.y, -0.5 * 0.84375);
  EXPECT_EQ(push.z, 0);
}

TEST(Boundary, ScalarsAgree) {
  for (const double taper : {0.0, 1.0}) {
    ExpectScalarsAgree(Walls{}, std::array{0.5, taper, -1.2, 5.3, 3.0});
    ExpectScalarsAgree(Walls{}, std::array{0.5, taper, 2.0, -2.3, 6.2});
  }
}

TEST(Boundary, Gradient) {
  ExpectGradientMatches(Walls{}, std::array{0.5, 1.0, -1.2, 5.3, 3.0});
  ExpectGradientMatches(Walls{}, std::array{0.5, 1.0, 2.0, -2.3, 6.2});
}

}  // namespace
}  // namespace flocklift
