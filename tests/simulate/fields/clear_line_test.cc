// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/clear_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/fields/distance_field.h"

namespace flocklift {
namespace {

constexpr double kSpacing = 0.1;
const Grid kGrid = GridOver({0, 0, 0}, {8, 5, 4}, kSpacing);
const std::vector<Solid> kObstacles = {Ball{{3, 2, 2}, 0.8}, Block{{5, 1, 0}, {5.6, 5, 3}}};

// The least distance on the line, by many small steps.
double Nearest(const Vec3d& from, const Vec3d& to) {
  double nearest = 1e9;
  for (int k = 0; k <= 2000; ++k) {
    nearest = std::min(nearest, SignedDistance(kObstacles, from + (k / 2000.0) * (to - from)));
  }
  return nearest;
}

TEST(IsClearLine, AgreesWithSmallSteps) {
  const ScalarField distance = DistanceField(kGrid, kObstacles);
  Rng rng(4);
  int clear = 0, met = 0;
  for (int k = 0; k < 4000; ++k) {
    const auto place = [&rng]() -> Vec3d {
      return {rng.Uniform(0, 8), rng.Uniform(0, 5), rng.Uniform(0, 4)};
    };
    const Vec3d from = place(), to = place();
    const double nearest = Nearest(from, to);
    // Between the nodes the distance is rounded by up to a part of the spacing.
    if (nearest > 0.3 + 0.5 * kSpacing) {
      EXPECT_TRUE(IsClearLine(distance, from, to, 0.3)) << k;
      ++clear;
    }
    if (nearest < 0.3 - 0.5 * kSpacing) {
      EXPECT_FALSE(IsClearLine(distance, from, to, 0.3)) << k;
      ++met;
    }
  }
  EXPECT_GT(clear, 500);
  EXPECT_GT(met, 500);
}

TEST(IsClearLine, APointIsALine) {
  const ScalarField distance = DistanceField(kGrid, kObstacles);
  EXPECT_TRUE(IsClearLine(distance, {1, 2, 2}, {1, 2, 2}, 1.1));
  EXPECT_FALSE(IsClearLine(distance, {1, 2, 2}, {1, 2, 2}, 1.3));
  EXPECT_FALSE(IsClearLine(distance, {3, 2, 2}, {3, 2, 2}, 0));
}

}  // namespace
}  // namespace flocklift
