// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Derivatives against differences: f is any functor with
//   template <typename T> Vec3<T> operator()(const T* in) const
// evaluated on ceres::Jet and, by Ridders' extrapolated differences, on double.

#ifndef FLOCKLIFT_TESTS_SUPPORT_GRADIENT_CHECK_H_
#define FLOCKLIFT_TESTS_SUPPORT_GRADIENT_CHECK_H_

#include <ceres/ceres.h>
#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>

#include "simulate/core/vec3.h"

namespace flocklift {

template <typename Functor>
struct AsCostFunctor {
  Functor f;

  template <typename T>
  bool operator()(const T* in, T* out) const {
    const Vec3<T> value = f(in);
    out[0] = value.x;
    out[1] = value.y;
    out[2] = value.z;
    return true;
  }
};

// Sample away from the joints of piecewise functions (0.2 % of each input and more), where the
// extrapolation errs.
template <typename Functor, std::size_t kInputs>
void ExpectGradientMatches(const Functor& f, const std::array<double, kInputs>& in,
                           double relative_tolerance = 1e-6) {
  const ceres::AutoDiffCostFunction<AsCostFunctor<Functor>, 3, static_cast<int>(kInputs)> cost(
      new AsCostFunctor<Functor>{f});
  const std::vector<const ceres::Manifold*>* euclidean = nullptr;
  ceres::NumericDiffOptions steps;
  steps.ridders_relative_initial_step_size = 1e-3;
  const ceres::GradientChecker checker(&cost, euclidean, steps);
  const double* const blocks[] = {in.data()};
  ceres::GradientChecker::ProbeResults results;
  EXPECT_TRUE(checker.Probe(blocks, relative_tolerance, &results)) << results.error_log;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_SUPPORT_GRADIENT_CHECK_H_
