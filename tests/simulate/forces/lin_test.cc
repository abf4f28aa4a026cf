// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/forces/lin.h"

#include <gtest/gtest.h>

#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

// in: w_sep, d_sep, exponent, taper, positions of the bird and of two others.
struct Target {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    const LinSeparation::Params<T> p{in[1], in[2], in[3]};
    const LinCohesion::Params<T> q{};
    const Vec3<T> x{in[4], in[5], in[6]}, none{T(0.0), T(0.0), T(0.0)};
    Weighted<T> separation, cohesion;
    for (const T* other = in + 7; other != in + 13; other += 3) {
      const Vec3<T> dx = Vec3<T>{other[0], other[1], other[2]} - x;
      separation += LinSeparation::Pair(p, dx, none);
      cohesion += LinCohesion::Pair(q, dx, none);
    }
    return LinTarget(x, in[0], LinSeparation::Finish(p, separation),
                     LinCohesion::Finish(q, cohesion));
  }
};

using Inputs = std::array<double, 13>;

// x = (1, 1, 1); others at distance 2 along x and at distance 5 (0, 3, 4).
constexpr Inputs With(double w_sep, double d_sep, double exponent, double taper = 0) {
  return {w_sep, d_sep, exponent, taper, 1, 1, 1, 3, 1, 1, 1, 4, 5};
}

TEST(Lin, Algorithm1ByHand) {
  // k = 0: mean of the unit offsets (-1, 0, 0) and (0, -3/5, -4/5).
  ExpectNear(Evaluate<double>(Target{}, With(1, 6, 0)), {1 - 0.5, 1 - 0.3, 1 - 0.4}, 1e-9);
  // Only the near one, counted once.
  ExpectNear(Evaluate<double>(Target{}, With(1, 4, 0)), {0, 1, 1}, 1e-9);
  // d <= d_sep: the edge itself is inside.
  ExpectNear(Evaluate<double>(Target{}, With(1, 2, 0)), {0, 1, 1}, 1e-9);
  ExpectNear(Evaluate<double>(Target{}, With(1, 1.99, 0)), {1, 1, 1}, 1e-9);
}

TEST(Lin, ExponentOneIsTheText) {
  // k = 1: unit offsets over the distance: (-1/2, 0, 0) and (0, -3/25, -4/25), mean of two.
  ExpectNear(Evaluate<double>(Target{}, With(1, 6, 1)), {1 - 0.25, 1 - 0.06, 1 - 0.08}, 1e-9);
}

TEST(Lin, CohesionIsOverAllOthers) {
  // (2, 0, 0) and (0, 3, 4), divided by N - 1 = 2, however small d_sep.
  ExpectNear(Evaluate<double>(Target{}, With(0, 0.1, 0)), {1 + 1, 1 + 1.5, 1 + 2}, 1e-9);
  ExpectNear(Evaluate<double>(Target{}, With(0.5, 4, 0)), {1 + 0.5 - 0.5, 1 + 0.75, 1 + 1}, 1e-9);
}

TEST(Lin, ScalarsAgree) {
  for (const double exponent : {0.0, 1.0, 0.5}) {
    ExpectScalarsAgree(Target{}, With(0.6, 4, exponent));
    ExpectScalarsAgree(Target{}, With(0.6, 4, exponent, 5));
  }
}

TEST(Lin, Gradient) {
  ExpectGradientMatches(Target{}, With(0.6, 4, 0.5, 5));
  ExpectGradientMatches(Target{}, With(0.3, 4, 1, 5));
}

}  // namespace
}  // namespace flocklift
