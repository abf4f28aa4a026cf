// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/flock_forces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/forces/window.h"

namespace flocklift::internal {
namespace {

constexpr double kStep = 1e-5;

FlockForces SomeForces() {
  FlockForces f = FlockForces::Usual({1, 2, 40}, 9, 7);
  Rng rng(5);
  for (double& x : f.unknowns) x += 0.1 * rng.Normal();
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

// Central difference of a force by `place`.
template <typename Force>
Eigen::Vector3d Slope(double* place, const Force& force) {
  const double before = *place;
  *place = before + kStep;
  const Vec3d up = force();
  *place = before - kStep;
  const Vec3d down = force();
  *place = before;
  const Vec3d slope = (0.5 / kStep) * (up - down);
  return {slope.x, slope.y, slope.z};
}

// Nobody near: no derivatives either, whatever stood in their place. (Where nobody was ever near,
// there is no memory for neighbours' own.)
TEST(FlockForces, NobodyIsNoForce) {
  PairUnknownsMatrix by_unknowns = PairUnknownsMatrix::Constant(99);
  const Vec3d force = PairForce(SomeForces())({}, nullptr, &by_unknowns);
  EXPECT_EQ(Norm(force), 0);
  EXPECT_EQ(by_unknowns.norm(), 0);
}

// Two neighbours well inside all radii: separation by hand, and so on.
TEST(FlockForces, ByHandFarFromEveryEdge) {
  FlockForces f = FlockForces::Usual({}, 10, 1);
  f.unknowns[kLogDs] = std::log(5);
  f.unknowns[kLogDv] = std::log(12);
  f.unknowns[kLogTaper] = std::log(2);
  f.unknowns[kLogAlphaS] = std::log(2);
  f.unknowns[kLogAlphaC] = std::log(0.1);
  f.unknowns[kLogAlphaA] = std::log(0.5);
  const std::vector<Offset> offsets = {{{2, 0, 0}, {1, 0, 0}}, {{0, 3, 0}, {0, 0, 2}}};
  const Vec3d force = PairForce(f)(offsets, nullptr, nullptr);
  // Mean offset (1, 1.5, 0), mean difference (0.5, 0, 1).
  EXPECT_NEAR(force.x, -2 * 1 + 0.1 * 1 + 0.5 * 0.5, 1e-12);
  EXPECT_NEAR(force.y, -2 * 1.5 + 0.1 * 1.5, 1e-12);
  EXPECT_NEAR(force.z, 0.5 * 1, 1e-12);
}

// Alone at 8 m/s, 30 m below its goal, with a mean speed of 10 m/s.
TEST(FlockForces, ByHandWithoutNeighbours) {
  FlockForces f = FlockForces::Usual({0, 30, 0}, 10, 1);
  f.unknowns[kLogCruise] = std::log(0.5);
  f.unknowns[kLogDrive] = std::log(1.2);
  f.unknowns[kLogLevel] = std::log(0.25);
  f.unknowns[kLogGoal] = std::log(0.4);
  f.unknowns[kLogRange] = std::log(40);
  f.up_in_cam = Vec3d{0, 1, 0};
  const Vec3d force = SelfForce(f, std::log(10), 0.3, {0, 0, 0}, {0, 8, 0}, nullptr);
  EXPECT_NEAR(force.y, 0.5 * (12 - 8) - 0.25 * 8 + 0.4 * 30 / std::sqrt(1 + 9.0 / 16), 1e-9);
  EXPECT_NEAR(std::hypot(force.x, force.z), 0, 1e-12);
}

// In the middle, on both edges of the taper, outside, and where the taper is wider than the radius.
TEST(FlockForces, WeightsAreThoseOfTheTerms) {
  for (const double taper : {2.0, 14.0}) {
    constexpr double kRadius = 5;
    const WeightWindow window(kRadius, taper);
    for (const double distance : {0.9, 3.9, 4.1, 5.0, 5.9, 6.1, 11.9, 12.1}) {
      const double square = distance * distance;
      const Weight weight = window.At(square);
      EXPECT_NEAR(weight.value, TaperWindow(square, kRadius, taper), 1e-12);
      EXPECT_NEAR(weight.value, window.ValueAt(square), 1e-12);
      const auto slope = [](const auto& value) {
        return (value(kStep) - value(-kStep)) / 2 / kStep;
      };
      const auto by_square = [&](double h) { return TaperWindow(square + h, kRadius, taper); };
      const auto by_radius = [&](double h) { return TaperWindow(square, kRadius + h, taper); };
      const auto by_taper = [&](double h) { return TaperWindow(square, kRadius, taper + h); };
      EXPECT_NEAR(weight.by_square, slope(by_square), 1e-7) << distance;
      EXPECT_NEAR(weight.by_radius, slope(by_radius), 1e-7) << distance;
      EXPECT_NEAR(weight.by_taper, slope(by_taper), 1e-7) << distance;
    }
  }
}

TEST(FlockForces, PairDerivativesAreThoseOfDifferences) {
  FlockForces f = SomeForces();
  std::vector<Offset> offsets = Neighbours(9);
  std::vector<ByOffset> by(offsets.size());
  PairUnknownsMatrix by_unknowns;
  const Vec3d force = PairForce(f)(offsets, by.data(), &by_unknowns);
  const auto plain = [&] { return PairForce(f)(offsets, nullptr, nullptr); };
  EXPECT_NEAR(Norm(force - plain()), 0, 1e-12);
  for (std::size_t j = 0; j < offsets.size(); ++j) {
    for (int c = 0; c < 6; ++c) {
      double* place = &Part(c < 3 ? &offsets[j].dx : &offsets[j].dv, c % 3);
      const Eigen::Vector3d column = c < 3 ? Eigen::Vector3d(by[j].ByPosition().col(c))
                                           : by[j].v * Eigen::Vector3d::Unit(c - 3);
      EXPECT_NEAR((column - Slope(place, plain)).norm(), 0, 1e-6) << j << " " << c;
    }
  }
  for (int k = 0; k < kPairUnknowns; ++k) {
    EXPECT_NEAR((by_unknowns.col(k) - Slope(&f.unknowns[k], plain)).norm(), 0, 1e-6) << k;
  }
}

TEST(FlockForces, SelfDerivativesAreThoseOfDifferences) {
  FlockForces f = SomeForces();
  Vec3d x{3, -2, 35}, v{6, 2, -5};
  double log_speed = 2.2;
  constexpr double kTime = 5.3;
  SelfDerivatives by;
  const Vec3d force = SelfForce(f, log_speed, kTime, x, v, &by);
  const auto plain = [&] { return SelfForce(f, log_speed, kTime, x, v, nullptr); };
  EXPECT_NEAR(Norm(force - plain()), 0, 1e-12);
  for (int c = 0; c < 6; ++c) {
    double* place = &Part(c < 3 ? &x : &v, c % 3);
    EXPECT_NEAR((by.by_state.col(c) - Slope(place, plain)).norm(), 0, 1e-6) << c;
  }
  EXPECT_NEAR((by.by_log_speed - Slope(&log_speed, plain)).norm(), 0, 1e-6);
  for (int k = 0; k < kSelfUnknowns; ++k) {
    double* place = &f.unknowns[kPairUnknowns + k];
    EXPECT_NEAR((by.by_unknowns.col(k) - Slope(place, plain)).norm(), 0, 1e-6) << k;
  }
  const FlockForces::Share share = f.ShareAt(kTime);
  ASSERT_EQ(share.knot, 1);
  for (int axis = 0; axis < 3; ++axis) {
    double* place = &f.unknowns[kForceScalars + 3 * (share.knot + 1) + axis];
    const Eigen::Vector3d expected = share.next * by.by_target.col(axis);
    EXPECT_NEAR((expected - Slope(place, plain)).norm(), 0, 1e-6) << axis;
  }
}

// A scene twice as large, at the same pace, has forces twice as large.
TEST(FlockForces, KnowsNoScale) {
  const FlockForces f = SomeForces();
  FlockForces larger = f;
  std::vector<Offset> offsets = Neighbours(9), far = offsets;
  for (int k = 0; k < kForceScalars; ++k) {
    if (IsLength(k)) larger.unknowns[k] += std::log(2.0);
  }
  larger.unknowns.tail(f.size() - kForceScalars) *= 2;
  for (Offset& o : far) o = {2 * o.dx, 2 * o.dv};
  const Vec3d x{3, -2, 35}, v{6, 2, -5};
  const Vec3d once = PairForce(f)(offsets, nullptr, nullptr) + SelfForce(f, 2.1, 3, x, v, nullptr);
  const Vec3d twice = PairForce(larger)(far, nullptr, nullptr) +
                      SelfForce(larger, 2.1 + std::log(2.0), 3, 2 * x, 2 * v, nullptr);
  EXPECT_NEAR(Norm(twice - 2 * once), 0, 1e-9);
}

TEST(FlockForces, TargetIsLinearBetweenItsKnots) {
  FlockForces f = FlockForces::Usual({1, 2, 3}, 10, 1);
  f.unknowns.tail(3) << 3, 2, 3;
  EXPECT_NEAR(f.TargetAt(0.25 * kTargetKnotTime).x, 1.5, 1e-12);
  EXPECT_NEAR(f.TargetAt(100).x, 3, 1e-12);
  EXPECT_NEAR(f.TargetAt(-1).x, 1, 1e-12);
}

}  // namespace
}  // namespace flocklift::internal
