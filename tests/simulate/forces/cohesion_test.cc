// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/forces/cohesion.h"

#include <gtest/gtest.h>

#include "simulate/core/rigid3.h"
#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

// in: gain, radius, taper, then dx and dv of two neighbours.
struct TwoNeighbours {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    const typename Cohesion::Params<T> p{in[0], in[1], in[2]};
    Weighted<T> sum;
    for (const T* n = in + 3; n != in + 15; n += 6) {
      sum += Cohesion::Pair(p, Vec3<T>{n[0], n[1], n[2]}, Vec3<T>{n[3], n[4], n[5]});
    }
    return Cohesion::Finish(p, sum);
  }
};

using Inputs = std::array<double, 15>;
constexpr Inputs kBothNear = {2, 3, 0, 1, 2, 0, 9, 9, 9, 1, 0, -2, 9, 9, 9};
constexpr Inputs kOneFar = {2, 3, 0, 1, 2, 0, 9, 9, 9, 4, 0, -2, 9, 9, 9};
constexpr Inputs kBothFar = {2, 3, 0, 3, 2, 0, 9, 9, 9, 4, 0, -2, 9, 9, 9};
constexpr Inputs kSoft = {2, 3, 2, 1, 2, 0, 9, 9, 9, 3, 0, -1, 9, 9, 9};

TEST(Cohesion, ByHand) {
  EXPECT_EQ(Evaluate<double>(TwoNeighbours{}, kBothNear), (Vec3d{2, 2, -2}));
  EXPECT_EQ(Evaluate<double>(TwoNeighbours{}, kOneFar), (Vec3d{2, 4, 0}));
  EXPECT_EQ(Evaluate<double>(TwoNeighbours{}, kBothFar), (Vec3d{}));
}

TEST(Cohesion, ScalarsAgree) {
  for (const Inputs& in : {kBothNear, kOneFar, kBothFar, kSoft}) {
    ExpectScalarsAgree(TwoNeighbours{}, in);
  }
}

TEST(Cohesion, Gradient) { ExpectGradientMatches(TwoNeighbours{}, kSoft); }

TEST(Cohesion, PairPullsTogetherWithEqualForces) {
  const Cohesion::Params<double> p{0.5, 3, 1};
  const Vec3d dx{1, -1, 0.5}, none{};
  const Vec3d on_i = One<Cohesion>(p, dx, none);
  EXPECT_EQ(on_i, -One<Cohesion>(p, -dx, none));
  EXPECT_GT(Dot(on_i, dx), 0);
}

TEST(Cohesion, TurnsWithTheWorld) {
  const Cohesion::Params<double> p{0.5, 3, 1};
  const Rotation3d turn = RotationFromQuaternion({0.5, 0.5, -0.5, 0.5});
  const Vec3d dx{1, -1, 2.4}, none{};
  ExpectNear(One<Cohesion>(p, turn * dx, none), turn * One<Cohesion>(p, dx, none), 1e-12);
}

}  // namespace
}  // namespace flocklift
