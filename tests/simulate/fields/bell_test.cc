// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/bell.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>

namespace flocklift {
namespace {

using Jet = ceres::Jet<double, 1>;

double Slope(double r) { return Bell(Jet(r, 0)).v[0]; }

TEST(Bell, ThePins) {
  EXPECT_DOUBLE_EQ(Bell(0.0), 1);
  EXPECT_NEAR(Bell(0.5), 0.5, 1e-15);
  EXPECT_NEAR(Bell(1.0), 0, 1e-15);
  EXPECT_DOUBLE_EQ(Bell(-3.0), 1);
  EXPECT_NEAR(Bell(7.0), 0, 1e-15);
  EXPECT_NEAR(Slope(0), 0, 1e-14);
  EXPECT_NEAR(Slope(1), 0, 1e-14);
}

TEST(Bell, FallsFromTheSurfaceOn) {
  for (double r = 0.01; r < 1; r += 0.01) {
    EXPECT_LT(Bell(r), Bell(r - 0.01));
    EXPECT_GT(Bell(r), 0);
    EXPECT_NEAR(Slope(r), (Bell(r + 1e-6) - Bell(r - 1e-6)) / 2e-6, 1e-8);
    EXPECT_NEAR(Bell(static_cast<float>(r)), Bell(r), 1e-6);
    EXPECT_NEAR(Bell(r), 1 - 22. / 9 * r * r + 17. / 9 * std::pow(r, 4) - 4. / 9 * std::pow(r, 6),
                1e-15);
  }
}

TEST(Bell, ReachesTwoDiagonals) {
  const double l = 0.5, diagonal = kCellDiagonal * l;
  EXPECT_DOUBLE_EQ(diagonal, std::sqrt(3) * l);
  EXPECT_DOUBLE_EQ(Repulsion(-0.1, diagonal), 1);
  EXPECT_NEAR(Repulsion(diagonal, diagonal), 0.5, 1e-15);
  EXPECT_GT(Repulsion(1.99 * diagonal, diagonal), 0);
  EXPECT_NEAR(Repulsion(2 * diagonal, diagonal), 0, 1e-15);
}

}  // namespace
}  // namespace flocklift
