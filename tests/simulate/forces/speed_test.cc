// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/forces/speed.h"

#include <gtest/gtest.h>

#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

// in: min, max, taper, velocity.
struct Clamp {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    return SpeedLimit::Limit(SpeedLimit::Params<T>{in[0], in[1], in[2]},
                             Vec3<T>{in[3], in[4], in[5]});
  }
};
// in: gain, speed, velocity.
struct Cruise {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    return CruiseSpeed::At(CruiseSpeed::Params<T>{in[0], in[1]}, Vec3<T>{},
                           Vec3<T>{in[2], in[3], in[4]});
  }
};

TEST(SpeedLimit, ByHand) {
  const auto at = [](double x, double y) {
    return Evaluate<double>(Clamp{}, std::array{5.0, 10.0, 0.0, x, y, 0.0});
  };
  ExpectNear(at(3, 4), {3, 4, 0}, 0);
  ExpectNear(at(4.2, 5.6), {4.2, 5.6, 0}, 0);
  ExpectNear(at(6, 8), {6, 8, 0}, 1e-9);
  ExpectNear(at(0.3, -0.4), {3, -4, 0}, 1e-9);
  ExpectNear(at(-30, 40), {-6, 8, 0}, 1e-9);
  ExpectNear(at(0, 0), {0, 0, 0}, 0);  // no direction: stays
}

TEST(SpeedLimit, SoftCornersStayInsideTheSharpOnes) {
  for (double speed = 0.25; speed < 20; speed += 0.25) {
    const double limited = Evaluate<double>(Clamp{}, std::array{5.0, 10.0, 1.0, speed, 0.0, 0.0}).x;
    EXPECT_GE(limited, 5 - 1e-9);
    EXPECT_LE(limited, 10 + 1e-9);
    EXPECT_NEAR(limited, std::min(10.0, std::max(5.0, speed)), 0.2501);
  }
}

TEST(SpeedLimit, ScalarsAgreeAndGradient) {
  for (const double x : {1.0, 4.8, 7.0, 10.2, 30.0}) {
    const std::array in{5.0, 10.0, 1.0, x, 0.5, -0.25};
    ExpectScalarsAgree(Clamp{}, in);
    ExpectGradientMatches(Clamp{}, in);
  }
  ExpectScalarsAgree(Clamp{}, std::array{5.0, 10.0, 0.0, 0.0, 0.0, 0.0});
}

TEST(CruiseSpeed, ByHand) {
  ExpectNear(Evaluate<double>(Cruise{}, std::array{0.5, 10.0, 3.0, 4.0, 0.0}), {1.5, 2, 0}, 1e-9);
  ExpectNear(Evaluate<double>(Cruise{}, std::array{0.5, 10.0, 0.0, 0.0, -12.0}), {0, 0, 1}, 1e-9);
  ExpectNear(Evaluate<double>(Cruise{}, std::array{0.5, 10.0, 0.0, 0.0, 0.0}), {0, 0, 0}, 0);
}

TEST(CruiseSpeed, ScalarsAgreeAndGradient) {
  const std::array in{0.5, 10.0, 3.0, 4.0, -2.0};
  ExpectScalarsAgree(Cruise{}, in);
  ExpectGradientMatches(Cruise{}, in);
}

}  // namespace
}  // namespace flocklift
