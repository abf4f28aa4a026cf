// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Derivatives of an error functor by automatic differentiation against ceres::GradientChecker's
// numeric ones (Ridders' extrapolation).

#ifndef FLOCKLIFT_TESTS_RECONSTRUCT_COST_FUNCTIONS_GRADIENT_CHECK_H_
#define FLOCKLIFT_TESTS_RECONSTRUCT_COST_FUNCTIONS_GRADIENT_CHECK_H_

#include <ceres/autodiff_cost_function.h>
#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace flocklift {

namespace internal {

// As ceres::AutoDiffCostFunction wants it.
template <typename Functor>
struct CheckedFunctor {
  Functor functor;
  template <typename T>
  bool operator()(const T* p, T* r) const {
    functor(p, r);
    return true;
  }
};

}  // namespace internal

// `functor(const T* parameters, T* residuals)` of `Parameters` numbers.
template <int Residuals, int Parameters, typename Functor>
void ExpectGradient(const Functor& functor, std::array<double, Parameters> parameters) {
  using Checked = internal::CheckedFunctor<Functor>;
  const ceres::AutoDiffCostFunction<Checked, Residuals, Parameters> cost(new Checked{functor});
  ceres::NumericDiffOptions options;
  options.ridders_relative_initial_step_size = 1e-4;
  const std::vector<const ceres::Manifold*> no_manifolds(1, nullptr);
  ceres::GradientChecker checker(&cost, &no_manifolds, options);
  const double* blocks[] = {parameters.data()};
  ceres::GradientChecker::ProbeResults results;
  EXPECT_TRUE(checker.Probe(blocks, 1e-6, &results)) << results.error_log;
}

// Control points of a path that flies across, away and upwards at some 45 m.
inline std::array<double, 9> SomePath() {
  return {0.11, -0.05, 3.80, 0.135, -0.052, 3.812, 0.163, -0.055, 3.821};
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_RECONSTRUCT_COST_FUNCTIONS_GRADIENT_CHECK_H_
