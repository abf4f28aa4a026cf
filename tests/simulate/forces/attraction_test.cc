// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/forces/attraction.h"

#include <gtest/gtest.h>

#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

// in: gain, range, target, position.
struct Pull {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    return Attraction::At(Attraction::Params<T>{in[0], {in[2], in[3], in[4]}, in[1]},
                          Vec3<T>{in[5], in[6], in[7]}, Vec3<T>{});
  }
};

TEST(Attraction, ByHand) {
  // 3-4-5: sqrt(1 + (|offset| / range)^2) = 5/3 at |offset| = 4, range 3.
  ExpectNear(Evaluate<double>(Pull{}, std::array{0.5, 3.0, 1.0, 1.0, 5.0, 1.0, 1.0, 1.0}),
             {0, 0, 0.5 * 4 * 3 / 5}, 1e-12);
  EXPECT_EQ(Evaluate<double>(Pull{}, std::array{0.5, 3.0, 1.0, 1.0, 5.0, 1.0, 1.0, 5.0}),
            (Vec3d{}));
}

TEST(Attraction, IsASpringNearByAndBoundedFarAway) {
  ExpectNear(Evaluate<double>(Pull{}, std::array{0.5, 1e4, 3.0, -4.0, 5.0, 0.0, 0.0, 0.0}),
             {1.5, -2, 2.5}, 1e-6);
  EXPECT_NEAR(Norm(Evaluate<double>(Pull{}, std::array{0.5, 6.0, 1e5, 0.0, 0.0, 0.0, 0.0, 0.0})), 3,
              1e-6);
}

TEST(Attraction, ScalarsAgreeAndGradient) {
  const std::array in{0.5, 3.0, 3.0, -4.0, 5.0, 1.0, 2.0, 0.5};
  ExpectScalarsAgree(Pull{}, in);
  ExpectGradientMatches(Pull{}, in);
}

}  // namespace
}  // namespace flocklift
