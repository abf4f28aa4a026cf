// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/forces/linear.h"

#include <gtest/gtest.h>

#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

// in: cohesion, alignment, then dx and dv of two others.
struct Sum {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    const LinearCohesion::Params<T> c{in[0]};
    const LinearAlignment::Params<T> a{in[1]};
    Weighted<T> cohesion, alignment;
    for (const T* n = in + 2; n != in + 14; n += 6) {
      const Vec3<T> dx{n[0], n[1], n[2]}, dv{n[3], n[4], n[5]};
      cohesion += LinearCohesion::Pair(c, dx, dv);
      alignment += LinearAlignment::Pair(a, dx, dv);
    }
    return LinearCohesion::Finish(c, cohesion) + LinearAlignment::Finish(a, alignment);
  }
};

constexpr std::array<double, 14> kInputs = {0.5, 2, 1, 2, 3, 0, 1, 0, -5, 0, 1, 0.25, 0, -1};

TEST(Linear, SumsAndDoesNotAverage) {
  ExpectNear(Evaluate<double>(Sum{}, kInputs), {-2 + 0.5, 1 + 2, 2 - 2}, 1e-12);
}

TEST(Linear, ScalarsAgreeAndGradient) {
  ExpectScalarsAgree(Sum{}, kInputs);
  ExpectGradientMatches(Sum{}, kInputs);
}

}  // namespace
}  // namespace flocklift
