// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/forces/flee.h"

#include <gtest/gtest.h>

#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

// in: gain, radius, taper, predators at two offsets.
struct TwoPredators {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    const Flee::Params<T> p{in[0], in[1], in[2]};
    Weighted<T> sum;
    sum += Flee::Pair(p, Vec3<T>{in[3], in[4], in[5]}, Vec3<T>{});
    sum += Flee::Pair(p, Vec3<T>{in[6], in[7], in[8]}, Vec3<T>{});
    return Flee::Finish(p, sum);
  }
};

TEST(Flee, ByHand) {
  // Unit pushes add up; a predator out of sight does not count.
  ExpectNear(Evaluate<double>(TwoPredators{}, std::array{2.0, 6.0, 0.0, 3., 4., 0., 0., 0., -1.}),
             {-1.2, -1.6, 2}, 1e-9);
  ExpectNear(Evaluate<double>(TwoPredators{}, std::array{2.0, 4.0, 0.0, 3., 4., 0., 0., 0., -1.}),
             {0, 0, 2}, 1e-9);
}

TEST(Flee, ScalarsAgreeAndGradient) {
  const std::array in{2.0, 5.0, 3.0, 3., 4., 0.5, 0.25, 0., -1.};
  ExpectScalarsAgree(TwoPredators{}, in);
  ExpectGradientMatches(TwoPredators{}, in);
}

}  // namespace
}  // namespace flocklift
