// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/flock_forces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulate/core/rng.h"

namespace flocklift::internal {
namespace {

FlockForces SomeForces() {
  FlockForces f;
  f.d_s = 5;
  f.d_v = 12;
  f.alpha_s = 1.5;
  f.alpha_c = 0.2;
  f.alpha_a = 0.8;
  f.cruise = 1.1;
  f.level = 0.6;
  f.spring = 0.3;
  f.center = {1, 2, 40};
  f.pull = {{0.5, 0, 0}, {0, 1, 0.2}};
  f.up_in_cam = Vec3d{0, -0.8, 0.6};
  return f;
}

std::vector<Offset> Neighbours(int count) {
  Rng rng(3);
  std::vector<Offset> offsets;
  for (int j = 0; j < count; ++j) {
    offsets.push_back({{rng.Uniform(-6, 6), rng.Uniform(-6, 6), rng.Uniform(-6, 6)},
                       {rng.Normal(), rng.Normal(), rng.Normal()}});
  }
  return offsets;
}

double& Part(Vec3d* v, int axis) { return axis == 0 ? v->x : axis == 1 ? v->y : v->z; }

// Two neighbours well inside all radii: separation by hand, and so on.
TEST(FlockForces, ByHandFarFromEveryEdge) {
  FlockForces f;
  f.d_s = 5;
  f.d_v = 12;
  f.alpha_s = 2;
  f.alpha_c = 0.1;
  f.alpha_a = 0.5;
  const std::vector<Offset> offsets = {{{2, 0, 0}, {1, 0, 0}}, {{0, 3, 0}, {0, 0, 2}}};
  const Vec3d force = PairForce(f, offsets, nullptr);
  // Mean offset (1, 1.5, 0), mean difference (0.5, 0, 1).
  EXPECT_NEAR(force.x, -2 * 1 + 0.1 * 1 + 0.5 * 0.5, 1e-12);
  EXPECT_NEAR(force.y, -2 * 1.5 + 0.1 * 1.5, 1e-12);
  EXPECT_NEAR(force.z, 0.5 * 1, 1e-12);
}

TEST(FlockForces, PairDerivativesAreThoseOfDifferences) {
  const FlockForces f = SomeForces();
  std::vector<Offset> offsets = Neighbours(9);
  std::vector<Matrix36> derivatives(offsets.size());
  const Vec3d force = PairForce(f, offsets, derivatives.data());
  const Vec3d plain = PairForce(f, offsets, nullptr);
  EXPECT_NEAR(Norm(force - plain), 0, 1e-12);
  constexpr double kStep = 1e-5;
  for (std::size_t j = 0; j < offsets.size(); ++j) {
    for (int c = 0; c < 6; ++c) {
      double& place = Part(c < 3 ? &offsets[j].dx : &offsets[j].dv, c % 3);
      const double before = place;
      place = before + kStep;
      const Vec3d up = PairForce(f, offsets, nullptr);
      place = before - kStep;
      const Vec3d down = PairForce(f, offsets, nullptr);
      place = before;
      Vec3d slope = (0.5 / kStep) * (up - down);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(derivatives[j](axis, c), Part(&slope, axis), 1e-6) << j << " " << c;
      }
    }
  }
}

TEST(FlockForces, SelfDerivativesAreThoseOfDifferences) {
  const FlockForces f = SomeForces();
  Vec3d x{3, -2, 35}, v{6, 2, -5};
  Matrix36 derivative;
  SelfForce(f, 9, 1.3, x, v, &derivative);
  constexpr double kStep = 1e-5;
  for (int c = 0; c < 6; ++c) {
    double& place = Part(c < 3 ? &x : &v, c % 3);
    const double before = place;
    place = before + kStep;
    const Vec3d up = SelfForce(f, 9, 1.3, x, v, nullptr);
    place = before - kStep;
    const Vec3d down = SelfForce(f, 9, 1.3, x, v, nullptr);
    place = before;
    Vec3d slope = (0.5 / kStep) * (up - down);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(derivative(axis, c), Part(&slope, axis), 1e-6);
    }
  }
}

TEST(FlockForces, IsLinearInItsGains) {
  const FlockForces f = SomeForces();
  const std::vector<Offset> offsets = Neighbours(7);
  const Vec3d x{3, -2, 35}, v{6, 2, -5};
  const auto unit = UnitForces(f, 9, offsets, x, v);
  const std::array<double, kForceGains> gains = {f.alpha_s, f.alpha_c, f.alpha_a,
                                                 f.cruise,  f.level,   f.spring};
  Vec3d sum = f.PullAt(0.7);
  for (std::size_t p = 0; p < gains.size(); ++p) sum += gains[p] * unit[p];
  const Vec3d whole = PairForce(f, offsets, nullptr) + SelfForce(f, 9, 0.7, x, v, nullptr);
  EXPECT_NEAR(Norm(whole - sum), 0, 1e-12);
}

TEST(FlockForces, PullIsLinearBetweenItsKnots) {
  const FlockForces f = SomeForces();
  EXPECT_NEAR(f.PullAt(0.5 * kPullKnotTime).x, 0.25, 1e-12);
  EXPECT_NEAR(f.PullAt(0.5 * kPullKnotTime).y, 0.5, 1e-12);
  EXPECT_NEAR(f.PullAt(100).y, 1, 1e-12);
  EXPECT_NEAR(f.PullAt(-1).x, 0.5, 1e-12);
}

}  // namespace
}  // namespace flocklift::internal
