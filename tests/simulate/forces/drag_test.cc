// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/forces/drag.h"

#include <gtest/gtest.h>

#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

static_assert(AgentTerm<Drag, float> && AgentTerm<Drag, double> && AgentTerm<Drag, Pack> &&
              AgentTerm<Drag, Jet>);

// in: gain, wind, velocity.
struct Brake {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    return Drag::At(Drag::Params<T>{in[0], Vec3<T>{in[1], in[2], in[3]}}, Vec3<T>{},
                    Vec3<T>{in[4], in[5], in[6]});
  }
};

TEST(Drag, ByHand) {
  EXPECT_EQ(Evaluate<double>(Brake{}, std::array{2.0, 0.0, 0.0, 0.0, 1.0, -3.0, 0.0}),
            (Vec3d{-2, 6, 0}));
  EXPECT_EQ(Evaluate<double>(Brake{}, std::array{2.0, 1.0, -3.0, 4.0, 1.0, -3.0, 0.0}),
            (Vec3d{0, 0, 8}));
}

TEST(Drag, ScalarsAgreeAndGradient) {
  const std::array in{2.0, 1.0, -3.0, 4.0, 0.5, -2.0, 1.0};
  ExpectScalarsAgree(Brake{}, in);
  ExpectGradientMatches(Brake{}, in);
}

}  // namespace
}  // namespace flocklift
