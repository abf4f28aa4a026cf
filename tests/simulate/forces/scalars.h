// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One functor, four scalars: float, double, a SIMD pack and ceres::Jet must tell the same.

#ifndef FLOCKLIFT_TESTS_SIMULATE_FORCES_SCALARS_H_
#define FLOCKLIFT_TESTS_SIMULATE_FORCES_SCALARS_H_

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <xsimd/xsimd.hpp>

#include "simulate/core/vec3.h"
#include "simulate/forces/term.h"

namespace flocklift {

using Pack = xsimd::batch<float>;
using Jet = ceres::Jet<double, 2>;

inline double Value(float x) { return static_cast<double>(x); }
inline double Value(double x) { return x; }
inline double Value(const Pack& x) { return static_cast<double>(x.get(Pack::size - 1)); }
inline double Value(const Jet& x) { return x.a; }

template <typename T>
Vec3d Values(const Vec3<T>& v) {
  return {Value(v.x), Value(v.y), Value(v.z)};
}

template <typename T, typename Functor, std::size_t kInputs>
Vec3d Evaluate(const Functor& f, const std::array<double, kInputs>& in) {
  std::array<T, kInputs> cast;
  for (std::size_t k = 0; k < kInputs; ++k) cast[k] = T(in[k]);
  return Values(f(cast.data()));
}

inline void ExpectNear(const Vec3d& actual, const Vec3d& expected, double tolerance) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(actual.z, expected.z, tolerance);
}

// f: template <typename T> Vec3<T> operator()(const T* in) const.
template <typename Functor, std::size_t kInputs>
void ExpectScalarsAgree(const Functor& f, const std::array<double, kInputs>& in,
                        double relative_tolerance = 1e-5) {
  const Vec3d expected = Evaluate<double>(f, in);
  const double tolerance = relative_tolerance * (1 + Norm(expected));
  ASSERT_TRUE(std::isfinite(Norm(expected)));
  {
    SCOPED_TRACE("float");
    ExpectNear(Evaluate<float>(f, in), expected, tolerance);
  }
  {
    SCOPED_TRACE("pack");
    ExpectNear(Evaluate<Pack>(f, in), expected, tolerance);
  }
  {
    SCOPED_TRACE("jet");
    ExpectNear(Evaluate<Jet>(f, in), expected, 1e-12 * (1 + Norm(expected)));
  }
}

// The acceleration that one neighbour causes.
template <typename Term>
Vec3d One(const typename Term::template Params<double>& p, const Vec3d& dx, const Vec3d& dv) {
  Weighted<double> sum;
  sum += Term::Pair(p, dx, dv);
  return Term::Finish(p, sum);
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_SIMULATE_FORCES_SCALARS_H_
