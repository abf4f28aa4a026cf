// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/forces/shape_force.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

static_assert(PairTerm<ShapeForce, float> && PairTerm<ShapeForce, double> &&
              PairTerm<ShapeForce, Pack> && PairTerm<ShapeForce, Jet>);

// in: gain, reach, sigma, taper, two offsets.
struct Push {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    const ShapeForce::Params<T> p{in[0], in[1], in[2], in[3]};
    Weighted<T> sum;
    sum += ShapeForce::Pair(p, Vec3<T>{in[4], in[5], in[6]}, Vec3<T>{});
    sum += ShapeForce::Pair(p, Vec3<T>{in[7], in[8], in[9]}, Vec3<T>{});
    return ShapeForce::Finish(p, sum);
  }
};

TEST(ShapeForce, ByHand) {
  // One neighbour at (1, 2, 2): 3 away, 5 by Manhattan; the other one is out of reach.
  const Vec3d push =
      Evaluate<double>(Push{}, std::array{6.0, 5.5, 2.0, 0.0, 1.0, 2.0, 2.0, 4.0, 1.0, 1.0});
  const double factor = -6 * std::exp(-25.0 / 8) / 3;
  ExpectNear(push, {factor, 2 * factor, 2 * factor}, 1e-9);
}

TEST(ShapeForce, FallIsTheExponential) {
  for (double y = 0; y < 2.5; y += 0.01) {
    EXPECT_NEAR(ShapeForce::Fall(y), std::exp(-y), 1e-10);
    EXPECT_NEAR(ShapeForce::Fall(static_cast<float>(y)), std::exp(-y), 3e-6);
  }
  for (double y = 0; y < 50; y += 0.1) EXPECT_NEAR(ShapeForce::Fall(y), std::exp(-y), 1e-5);
}

TEST(ShapeForce, PushesApartAndCancelsInTheMiddle) {
  const std::array in{1.0, 5.0, 2.0, 0.0, 1.0, 0.5, 0.0, -1.0, -0.5, 0.0};
  EXPECT_NEAR(Norm(Evaluate<double>(Push{}, in)), 0, 1e-15);
  const ShapeForce::Params<double> p{1, 5, 2, 0};
  const Vec3d dx{1, 1, 0};
  EXPECT_LT(Dot(One<ShapeForce>(p, dx, {}), dx), 0);
  ExpectNear(One<ShapeForce>(p, dx, {}) + One<ShapeForce>(p, -dx, {}), {}, 1e-15);
}

TEST(ShapeForce, ScalarsAgreeAndGradient) {
  for (const double taper : {0.0, 1.0}) {
    const std::array in{2.0, 4.0, 1.8, taper, 0.7, -0.9, 0.4, -1.2, 1.5, 1.1};
    ExpectScalarsAgree(Push{}, in);
    if (taper > 0) ExpectGradientMatches(Push{}, in);
  }
}

}  // namespace
}  // namespace flocklift
