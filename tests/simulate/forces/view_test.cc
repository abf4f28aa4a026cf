// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/forces/view.h"

#include <gtest/gtest.h>

#include <numbers>

#include "simulate/core/rigid3.h"
#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

// in: heading, cosine, taper, dx; out: (weight, its hard edge, 0).
struct Weights {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    const Vec3<T> heading{in[0], in[1], in[2]}, dx{in[5], in[6], in[7]};
    return {Seen(ViewCone<T>{heading, in[3], in[4]}, dx),
            Seen(ViewCone<T, HardEdge>{heading, in[3], {}}, dx), T(0.0)};
  }
};
using Inputs = std::array<double, 8>;

double Hard(const Vec3d& heading, double cosine, const Vec3d& dx) {
  return Seen(ViewCone<double, HardEdge>{heading, cosine, {}}, dx);
}

TEST(View, ByHand) {
  const Vec3d ahead{1, 0, 0};
  // A quarter of the circle: 45 degrees to each side.
  EXPECT_EQ(Hard(ahead, std::sqrt(0.5), {2, 1.9, 0}), 1);
  EXPECT_EQ(Hard(ahead, std::sqrt(0.5), {2, 2.1, 0}), 0);
  EXPECT_EQ(Hard(ahead, std::sqrt(0.5), {-2, 1, 0}), 0);
  // Blind behind, 45 degrees to each side of the tail.
  EXPECT_EQ(Hard(ahead, -std::sqrt(0.5), {-2, 2.1, 0}), 1);
  EXPECT_EQ(Hard(ahead, -std::sqrt(0.5), {-2, 0, 1.9}), 0);
  EXPECT_EQ(Hard(ahead, -1, {-2, 0, 0}), 1);
  // Half way up the soft edge, and its two ends.
  const auto soft = [&](double cosine) {
    return Seen(ViewCone<double>{ahead, cosine, 0.5}, Vec3d{3, 4, 0});
  };
  EXPECT_NEAR(soft(0.6), 0.5, 1e-9);
  EXPECT_NEAR(soft(0.34), 1, 1e-9);
  EXPECT_NEAR(soft(0.86), 0, 1e-9);
  EXPECT_NEAR(soft(0.725), 0.15625, 1e-9);  // u = 1/4
}

TEST(View, HardEdgeIsTheAngle) {
  for (int degrees = 1; degrees < 180; degrees += 7) {
    const double limit = std::cos(degrees * std::numbers::pi / 180);
    for (int k = 0; k < 180; ++k) {
      const double angle = (k + 0.5) * std::numbers::pi / 180;
      const Vec3d dx{5 * std::cos(angle), 0, -5 * std::sin(angle)};
      EXPECT_EQ(Hard({1, 0, 0}, limit, dx), k < degrees ? 1 : 0) << degrees << " " << k;
    }
  }
}

TEST(View, AtRestEveryAngleIsARightOne) {
  EXPECT_EQ(Hard({}, -0.5, {1, 2, 3}), 1);
  EXPECT_EQ(Hard({}, 0.5, {1, 2, 3}), 0);
}

TEST(View, TurnsWithTheWorld) {
  const Rotation3d turn = RotationFromQuaternion({0.5, 0.5, -0.5, 0.5});
  const Vec3d heading = Normalized({1, 2, -0.5}), dx{0.3, 1, -0.7};
  const ViewCone<double> view{heading, 0.9, 0.4}, turned{turn * heading, 0.9, 0.4};
  const double weight = Seen(view, dx);
  EXPECT_GT(weight, 0.05);
  EXPECT_LT(weight, 0.95);
  EXPECT_NEAR(Seen(turned, turn * dx), weight, 1e-12);
}

TEST(View, ScalarsAgreeAndGradient) {
  for (const double taper : {0.0, 0.5}) {
    ExpectScalarsAgree(Weights{}, Inputs{0.6, 0, 0.8, -0.3, taper, 1, 2, -0.5});
    ExpectScalarsAgree(Weights{}, Inputs{0.6, 0, 0.8, 0.3, taper, 1, 2, -0.5});
  }
  ExpectGradientMatches(Weights{}, Inputs{0.6, 0.1, 0.8, -0.1, 0.7, 1, 2, -0.5});
}

}  // namespace
}  // namespace flocklift
