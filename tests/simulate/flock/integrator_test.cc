// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/integrator.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

// in: acceleration, velocity, dt.
struct NewPosition {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    Vec3<T> x{T(1.0), T(2.0), T(3.0)}, v{in[3], in[4], in[5]};
    Advance(Vec3<T>{in[0], in[1], in[2]}, in[6], SpeedLimit::Params<T>{T(2.0), T(6.0), T(1.0)}, &x,
            &v);
    return x;
  }
};

TEST(Advance, MovesWithTheNewVelocity) {
  Vec3d x{1, 0, 0}, v{2, 0, 0};
  Advance({0, 10, 0}, 0.1, SpeedLimit::Params<double>{0, 100, 0}, &x, &v);
  EXPECT_NEAR(v.y, 1, 1e-12);
  EXPECT_NEAR(x.x, 1.2, 1e-12);
  EXPECT_NEAR(x.y, 0.1, 1e-12);
}

TEST(Advance, LimitsTheSpeedBeforeTheMove) {
  Vec3d x{}, v{3, 0, 0};
  Advance({100, 0, 0}, 0.1, SpeedLimit::Params<double>{1, 5, 0}, &x, &v);
  EXPECT_NEAR(v.x, 5, 1e-9);
  EXPECT_NEAR(x.x, 0.5, 1e-9);
}

// Symplectic: the energy of a spring does not run away, as it does with explicit Euler.
TEST(Advance, KeepsTheEnergyOfASpring) {
  Vec3d x{1, 0, 0}, v{};
  double most = 0;
  for (int step = 0; step < 10000; ++step) {
    Advance(-4.0 * x, 0.05, SpeedLimit::Params<double>{0, 100, 0}, &x, &v);
    most = std::max(most, 0.5 * SquaredNorm(v) + 2 * SquaredNorm(x));
  }
  EXPECT_LT(most, 2.3);
}

TEST(Advance, Gradient) {
  for (const double vx : {1.0, 4.0, 7.0}) {
    ExpectGradientMatches(NewPosition{}, std::array{1.0, 2.0, -0.5, vx, 0.5, 0.25, 0.1});
  }
}

}  // namespace
}  // namespace flocklift
