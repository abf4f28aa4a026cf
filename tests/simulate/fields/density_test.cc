// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/density.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

TEST(Density, ByHand) {
  const Grid grid{{0, 0, 0}, 2, 3, 3, 3};
  const ScalarField one = DensityField(grid, std::vector<Vec3d>{{2, 2, 4}});
  EXPECT_FLOAT_EQ(one.values[grid.Index(1, 1, 2)], 1.0F / 8);
  const ScalarField between = DensityField(grid, std::vector<Vec3d>{{1, 2, 0}});
  EXPECT_FLOAT_EQ(between.values[grid.Index(0, 1, 0)], 0.5F / 8);
  EXPECT_FLOAT_EQ(between.values[grid.Index(1, 1, 0)], 0.5F / 8);
}

TEST(Density, CountsEverybody) {
  for (const int layers : {7, 1}) {
    const Grid grid{{-1, -1, 0}, 0.4, 6, 5, layers};
    Rng rng(1);
    std::vector<Vec3d> animals;
    for (int k = 0; k < 500; ++k) {
      animals.push_back({rng.Uniform(-2, 2), rng.Uniform(-2, 2), rng.Uniform(-1, 3)});
    }
    const ScalarField density = DensityField(grid, animals);
    const double sum = std::accumulate(density.values.begin(), density.values.end(), 0.0);
    EXPECT_NEAR(sum * (layers > 1 ? 0.4 * 0.4 * 0.4 : 0.4 * 0.4), 500, 1e-2);
  }
}

}  // namespace
}  // namespace flocklift
