// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/wall_potential.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulate/core/rng.h"
#include "simulate/flock/kernels/lattice_pack.h"
#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

constexpr std::uint32_t kSeed = 77;
constexpr double kGain = 0.5, kScale = 0.8, kReach = 0.6;

// The distance to a ball of radius 2 about the origin.
struct Ball {
  template <typename T>
  WallDistance<T> operator()(const Vec3<T>& x) const {
    using std::sqrt;
    const T r = sqrt(SquaredNorm(x));
    const Vec3<T> n = x / r;
    const auto row = [&](const T& component, const Vec3<T>& axis) -> Vec3<T> {
      return (axis - n * component) / r;
    };
    const T zero(0.0), one(1.0);
    return {
        r - T(2.0),
        n,
        {row(n.x, {one, zero, zero}), row(n.y, {zero, one, zero}), row(n.z, {zero, zero, one})}};
  }
};

// A function that is 0 on an ellipsoid, without being a distance: |grad d| changes.
struct Ellipsoid {
  template <typename T>
  WallDistance<T> operator()(const Vec3<T>& x) const {
    const T zero(0.0), a(0.5), b(0.3), c(0.2);
    return {a * x.x * x.x + b * x.y * x.y + c * x.z * x.z - T(1.0),
            {T(2.0) * a * x.x, T(2.0) * b * x.y, T(2.0) * c * x.z},
            {{T(2.0) * a, zero, zero}, {zero, T(2.0) * b, zero}, {zero, zero, T(2.0) * c}}};
  }
};

template <typename Wall>
struct Velocity {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    const Vec3<T> x{in[0], in[1], in[2]};
    return CurlNearWall(NoisePotential(NoiseTerm<T>{T(kGain), T(kScale), kSeed}, x), Wall{}(x),
                        T(kReach));
  }
};

// N' itself, by its definition.
template <typename Wall>
Vec3d Potential(const Vec3d& x) {
  const Vec3d noise = NoisePotential(NoiseTerm<double>{kGain, kScale, kSeed}, x).value;
  const WallDistance<double> wall = Wall{}(x);
  const Vec3d n = wall.gradient / Norm(wall.gradient);
  const double a = Ramp(wall.value / kReach);
  return a * noise + (1 - a) * Dot(n, noise) * n;
}

Vec3d At(const auto& velocity, const Vec3d& x) {
  return Evaluate<double>(velocity, std::array{x.x, x.y, x.z});
}

// Points from a little inside the ball to beyond the reach of its wall.
Vec3d NearBall(Rng* rng) {
  const Vec3d way{rng->Normal(), rng->Normal(), rng->Normal()};
  return rng->Uniform(1.8, 3.0) * Normalized(way);
}

TEST(Ramp, ByHand) {
  EXPECT_EQ(Ramp(0.0), 0);
  EXPECT_EQ(Ramp(1.0), 1);
  EXPECT_EQ(Ramp(-0.5), 0);
  EXPECT_EQ(Ramp(7.0), 1);
  EXPECT_DOUBLE_EQ(Ramp(0.5), 0.79296875);  // 15/16 - 10/64 + 3/256
  EXPECT_EQ(RampSlope(0.0), 1.875);
  EXPECT_EQ(RampSlope(1.0), 0);
  EXPECT_EQ(RampSlope(-1.0), 0);
  EXPECT_EQ(RampSlope(2.0), 0);
  for (double u = 0.05; u < 1; u += 0.1) {
    EXPECT_NEAR(RampSlope(u), (Ramp(u + 1e-6) - Ramp(u - 1e-6)) / 2e-6, 1e-8);
  }
}

template <typename Wall>
void ExpectCurlOfPotential() {
  Rng rng(1);
  const double h = 1e-6;
  for (int k = 0; k < 100; ++k) {
    const Vec3d x = NearBall(&rng);
    const double d = Wall{}(x).value;
    if (std::abs(d) < 1e-4) continue;  // the ramp has a joint there
    const auto slope = [&](const Vec3d& axis) {
      return (Potential<Wall>(x + h * axis) - Potential<Wall>(x - h * axis)) / (2 * h);
    };
    const Vec3d dx = slope({1, 0, 0}), dy = slope({0, 1, 0}), dz = slope({0, 0, 1});
    ExpectNear(At(Velocity<Wall>{}, x), {dy.z - dz.y, dz.x - dx.z, dx.y - dy.x}, 1e-7);
  }
}

TEST(WallPotential, IsTheCurlOfItsPotential) {
  ExpectCurlOfPotential<Ball>();
  ExpectCurlOfPotential<Ellipsoid>();
}

template <typename Wall>
void ExpectNoSources() {
  using Dual = ceres::Jet<double, 3>;
  Rng rng(2);
  for (int k = 0; k < 1000; ++k) {
    const Vec3d x = NearBall(&rng);
    const Dual at[3] = {Dual(x.x, 0), Dual(x.y, 1), Dual(x.z, 2)};
    const Vec3<Dual> v = Velocity<Wall>{}(at);
    const double steepness = v.x.v.norm() + v.y.v.norm() + v.z.v.norm();
    EXPECT_LE(std::abs(v.x.v[0] + v.y.v[1] + v.z.v[2]), 1e-13 * (1 + steepness));
  }
}

TEST(WallPotential, DivergenceIsZeroToRoundOff) {
  ExpectNoSources<Ball>();
  ExpectNoSources<Ellipsoid>();
}

TEST(WallPotential, NothingFlowsThroughTheWall) {
  Rng rng(3);
  double fastest = 0;
  for (int k = 0; k < 500; ++k) {
    const Vec3d n = Normalized(Vec3d{rng.Normal(), rng.Normal(), rng.Normal()});
    const Vec3d v = At(Velocity<Ball>{}, 2.0 * n);
    EXPECT_NEAR(Dot(v, n), 0, 1e-14);
    fastest = std::max(fastest, Norm(v));

    const Vec3d on{std::sqrt(2.0) * n.x, std::sqrt(1 / 0.3) * n.y, std::sqrt(5.0) * n.z};
    EXPECT_NEAR(Dot(At(Velocity<Ellipsoid>{}, on), Normalized(Ellipsoid{}(on).gradient)), 0, 1e-13);
  }
  EXPECT_GT(fastest, 0.1);  // along it
}

TEST(WallPotential, IsPlainCurlNoiseBeyondItsReach) {
  Rng rng(4);
  for (int k = 0; k < 100; ++k) {
    const Vec3d x =
        rng.Uniform(2.61, 5) * Normalized(Vec3d{rng.Normal(), rng.Normal(), rng.Normal()});
    ExpectNear(At(Velocity<Ball>{}, x), CurlNoise(NoiseTerm<double>{kGain, kScale, kSeed}, x),
               1e-14);
  }
}

TEST(WallPotential, ScalarsAgreeAndDifferentiate) {
  Rng rng(5);
  for (int k = 0; k < 50; ++k) {
    const Vec3d x = NearBall(&rng);
    ExpectScalarsAgree(Velocity<Ball>{}, std::array{x.x, x.y, x.z}, 3e-5);
  }
  ExpectGradientMatches(Velocity<Ball>{}, std::array{1.3, 1.4, -1.0});
  ExpectGradientMatches(Velocity<Ellipsoid>{}, std::array{1.1, 1.1, -1.3});
}

TEST(WallPotential, StaysFiniteWhereThereIsNoNormal) {
  const PotentialSample<double> noise =
      NoisePotential(NoiseTerm<double>{kGain, kScale, kSeed}, Vec3d{0.1, 0.2, 0.3});
  const WallDistance<double> flat{0.5 * kReach, {}, {}};
  ExpectNear(CurlNearWall(noise, flat, kReach), Ramp(0.5) * Curl(noise), 1e-15);
}

}  // namespace
}  // namespace flocklift
