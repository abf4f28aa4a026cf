// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <ceres/dynamic_autodiff_cost_function.h>
#include <gtest/gtest.h>

#include <cmath>

#include "reconstruct/solve/lin_objective.h"
#include "tests/reconstruct/cost_functions/gradient_check.h"

namespace flocklift::internal {
namespace {

constexpr double kFps = 30;

CobylaOptions Options() {
  CobylaOptions options;
  options.lambda_speed = 12;
  options.near = 10;
  options.far = 100;
  options.d_sep = 6;
  return options;
}

// Five animals some 40 m away in their third frame and later, about 0.4 m from where they were.
std::vector<LinAnimal> Animals() {
  std::vector<LinAnimal> animals;
  for (int n = 0; n < 5; ++n) {
    const Vec3d last{2.0 * n - 5, 0.5 * n - 1, 38.0 + n};
    const Vec3d velocity{0.3, 0.02 * n, 0.2};
    const Vec3d now = last + velocity;
    animals.push_back({(1 / now.z) * now, 2, last, last - 1.1 * velocity});
  }
  return animals;
}

TEST(LinCeres, StepsGradient) {
  const LinAnimal a = Animals()[1];
  ExpectGradient<1, 1>(
      [&](const auto* depth, auto* error) {
        LinStepError{a.ray, a.last, 0.4}(depth, error);
      },
      {a.last.z + 0.3});
}

TEST(LinCeres, StandingTargetsGradient) {
  const LinAnimal a = Animals()[1];
  ExpectGradient<3, 1>(
      [&](const auto* depth, auto* error) {
        LinTargetError{a.ray, {1, 2, 40}}(depth, error);
      },
      {a.last.z + 0.3});
}

TEST(LinCeres, MovingTargetsGradient) {
  CobylaOptions options = Options();
  options.separation_exponent = 1;
  const std::vector<LinAnimal> animals = Animals();
  ExpectGradient<3, 5>(
      [&](const auto* depths, auto* error) {
        using T = std::remove_cvref_t<decltype(*depths)>;
        const std::array<const T*, 5> each = {depths, depths + 1, depths + 2, depths + 3,
                                              depths + 4};
        LinMovingTargetError{&options, &animals, 2}(each.data(), error);
      },
      {38.2, 39.3, 40.1, 41.4, 42.2});
}

// Both optimisers look for the minimum of the same function; Ceres must not end higher.
TEST(LinCeres, EndsNoHigherThanCobyla) {
  for (const bool current_frame : {false, true}) {
    for (const int solved_frames : {1, 2}) {
      CobylaOptions options = Options();
      options.current_frame = current_frame;
      options.tolerance = 1e-7;
      std::vector<LinAnimal> animals = Animals();
      for (LinAnimal& a : animals) a.solved_frames = solved_frames;
      std::vector<double> by_cobyla, by_ceres;
      for (const LinAnimal& a : animals) by_cobyla.push_back(a.last.z);
      by_ceres = by_cobyla;
      bool exhausted = true;
      const double cobyla = MinimizeLinByCobyla(options, kFps, animals, &by_cobyla, &exhausted);
      const double ceres = MinimizeLinByCeres(options, kFps, animals, &by_ceres, &exhausted);
      EXPECT_NEAR(ceres, LinObjective(options, kFps, animals, by_ceres), 1e-12);
      EXPECT_LE(ceres, cobyla + 1e-2) << current_frame << solved_frames;
      for (const double depth : by_ceres) {
        EXPECT_GE(depth, options.near);
        EXPECT_LE(depth, options.far);
      }
    }
  }
}

}  // namespace
}  // namespace flocklift::internal
