// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/forces/alignment.h"

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
    const typename Alignment::Params<T> p{in[0], in[1], in[2]};
    Weighted<T> sum;
    for (const T* n = in + 3; n != in + 15; n += 6) {
      sum += Alignment::Pair(p, Vec3<T>{n[0], n[1], n[2]}, Vec3<T>{n[3], n[4], n[5]});
    }
    return Alignment::Finish(p, sum);
  }
};

using Inputs = std::array<double, 15>;
constexpr Inputs kBothNear = {2, 3, 0, 1, 2, 0, 4, 0, 1, 1, 0, -2, 0, -2, 1};
constexpr Inputs kOneFar = {2, 3, 0, 1, 2, 0, 4, 0, 1, 4, 0, -2, 0, -2, 1};
constexpr Inputs kBothFar = {2, 3, 0, 3, 2, 0, 4, 0, 1, 4, 0, -2, 0, -2, 1};
constexpr Inputs kSoft = {2, 3, 2, 1, 2, 0, 4, 0, 1, 3, 0, -1, 0, -2, 1};

TEST(Alignment, ByHand) {
  EXPECT_EQ(Evaluate<double>(TwoNeighbours{}, kBothNear), (Vec3d{4, -2, 2}));
  EXPECT_EQ(Evaluate<double>(TwoNeighbours{}, kOneFar), (Vec3d{8, 0, 2}));
  EXPECT_EQ(Evaluate<double>(TwoNeighbours{}, kBothFar), (Vec3d{}));
}

TEST(Alignment, ScalarsAgree) {
  for (const Inputs& in : {kBothNear, kOneFar, kBothFar, kSoft}) {
    ExpectScalarsAgree(TwoNeighbours{}, in);
  }
}

TEST(Alignment, Gradient) { ExpectGradientMatches(TwoNeighbours{}, kSoft); }

// The sign of u_j - u_i: the other one makes the velocities run apart.
TEST(Alignment, TwoAnimalsConverge) {
  const Alignment::Params<double> p{1, 3, 0};
  Vec3d vi{1, 0, 0}, vj{0, 2, 1};
  const Vec3d momentum = vi + vj, dx{1, 0, 0};
  for (int step = 0; step < 200; ++step) {
    const Vec3d ai = One<Alignment>(p, dx, vj - vi);
    const Vec3d aj = One<Alignment>(p, -dx, vi - vj);
    vi += 0.05 * ai;
    vj += 0.05 * aj;
  }
  ExpectNear(vi, vj, 1e-6);
  ExpectNear(vi + vj, momentum, 1e-12);
}

}  // namespace
}  // namespace flocklift
