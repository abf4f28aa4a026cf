// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/forces/opensteer.h"

#include <gtest/gtest.h>

#include "simulate/core/rigid3.h"
#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

// in: gain, radius, near, taper, heading, cosine, its taper, then dx and dh of two neighbours.
template <typename Term>
struct TwoNeighbours {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    const typename Term::template Params<T> p{
        in[0], in[1], in[2], in[3], {{in[4], in[5], in[6]}, in[7], in[8]}};
    Weighted<T> sum;
    for (const T* n = in + 9; n != in + 21; n += 6) {
      sum += Term::Pair(p, Vec3<T>{n[0], n[1], n[2]}, Vec3<T>{n[3], n[4], n[5]});
    }
    return Term::Finish(p, sum);
  }
};
using Inputs = std::array<double, 21>;

// Heading along x, sight of 120 degrees to each side, 6 m far; 1 m near.
constexpr Inputs With(const Vec3d& a, const Vec3d& g, const Vec3d& b, const Vec3d& h,
                      double taper = 0, double view_taper = 0) {
  return {2,   6,   1,   taper, 1,   0,   0,   -0.5, view_taper, a.x, a.y,
          a.z, g.x, g.y, g.z,   b.x, b.y, b.z, h.x,  h.y,        h.z};
}

template <typename Term>
Vec3d Force(const Inputs& in) {
  return Evaluate<double>(TwoNeighbours<Term>{}, in);
}

TEST(OpenSteer, ByHand) {
  const Vec3d far{9, 0, 0}, up{0, 0, 1}, left{0, 1, 0};
  // Away with the weight of the rule, however far and however many.
  ExpectNear(Force<SteerSeparation>(With({3, 4, 0}, up, far, up)), {-1.2, -1.6, 0}, 1e-9);
  // 1/d each: (-1/2, 0, 0) and (0, -1/4, 0).
  ExpectNear(Force<SteerSeparation>(With({2, 0, 0}, up, {0, 4, 0}, up)),
             {-4 / std::sqrt(5), -2 / std::sqrt(5), 0}, 1e-9);
  ExpectNear(Force<SteerAlignment>(With({2, 0, 0}, up, {0, 4, 0}, left)),
             {0, std::sqrt(2), std::sqrt(2)}, 1e-9);
  ExpectNear(Force<SteerCohesion>(With({3, 0, 0}, up, {0, 4, 0}, up)), {1.2, 1.6, 0}, 1e-9);
  ExpectNear(Force<SteerCohesion>(With(far, up, far, up)), {}, 1e-9);
}

TEST(OpenSteer, WhatIsBehindCountsOnlyWhenNear) {
  const Vec3d far{9, 0, 0}, up{0, 0, 1};
  ExpectNear(Force<SteerCohesion>(With({-2, 0, 0}, up, far, up)), {}, 1e-9);
  ExpectNear(Force<SteerAlignment>(With({-2, 0, 0}, up, far, up)), {}, 1e-9);
  ExpectNear(Force<SteerCohesion>(With({-0.9, 0, 0}, up, far, up)), {-2, 0, 0}, 1e-9);
}

TEST(OpenSteer, HardEdgeIsTaperZero) {
  const SteerParams<double, HardEdge> hard{2, 6, 1, {}, {{1, 0, 0}, -0.5, {}}};
  const SteerParams<double> soft{2, 6, 1, 0, {{1, 0, 0}, -0.5, 0}};
  for (const Vec3d& dx : {Vec3d{3, 4, 0}, Vec3d{-2, 0, 1}, Vec3d{-0.5, 0, 0.1}, Vec3d{7, 0, 0}}) {
    EXPECT_EQ(SteerWeight(hard, dx), SteerWeight(soft, dx));
  }
}

TEST(OpenSteer, TheLastNeighbourLeavesSoftly) {
  const Vec3d far{9, 0, 0}, up{0, 0, 1};
  double before = Norm(Force<SteerCohesion>(With({5, 0, 0}, up, far, up, 1)));
  EXPECT_NEAR(before, 2, 1e-9);
  for (double r = 5.01; r < 6.6; r += 0.01) {
    const double now = Norm(Force<SteerCohesion>(With({r, 0, 0}, up, far, up, 1)));
    EXPECT_LE(now, before + 1e-12);
    EXPECT_LT(before - now, 0.1);
    before = now;
  }
  EXPECT_EQ(before, 0);
}

template <typename Term>
void CheckScalarsGradientAndTurns() {
  const Vec3d a{2, 5.6, -0.5}, g{0.5, -1, 0.2}, b{-1.5, 2.2, 0.4}, h{-1, 0.3, 0.1};
  const Inputs hard = With(a, g, b, h), soft = With(a, g, b, h, 1.5, 0.3);
  ExpectScalarsAgree(TwoNeighbours<Term>{}, hard);
  ExpectScalarsAgree(TwoNeighbours<Term>{}, soft);
  ExpectGradientMatches(TwoNeighbours<Term>{}, soft);

  const Rotation3d turn = RotationFromQuaternion({0.5, 0.5, -0.5, 0.5});
  Inputs turned = With(turn * a, turn * g, turn * b, turn * h, 1.5, 0.3);
  const Vec3d heading = turn * Vec3d{1, 0, 0};
  turned[4] = heading.x;
  turned[5] = heading.y;
  turned[6] = heading.z;
  ExpectNear(Force<Term>(turned), turn * Force<Term>(soft), 1e-12);
}

TEST(OpenSteer, Separation) { CheckScalarsGradientAndTurns<SteerSeparation>(); }
TEST(OpenSteer, Alignment) { CheckScalarsGradientAndTurns<SteerAlignment>(); }
TEST(OpenSteer, Cohesion) { CheckScalarsGradientAndTurns<SteerCohesion>(); }

}  // namespace
}  // namespace flocklift
