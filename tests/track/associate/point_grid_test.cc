// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/point_grid.h"

#include <gtest/gtest.h>

#include <set>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

TEST(PointGridTest, AgreesWithBruteForce) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    std::vector<Vec2d> points;
    for (int k = 0; k < 80; ++k) points.push_back({rng.Uniform(-50, 300), rng.Uniform(-5, 900)});
    points.push_back({1e7, -3e6});  // an outlier does not make a huge grid
    const PointGrid grid(points, 5);
    for (int k = 0; k < 30; ++k) {
      const Vec2d p{rng.Uniform(-100, 400), rng.Uniform(-100, 1000)};
      const double radius = rng.Uniform(1, 200);
      std::set<int> found, expected;
      grid.ForEachWithin(p, radius, [&](int index, double distance2) {
        EXPECT_TRUE(found.insert(index).second);
        EXPECT_DOUBLE_EQ(distance2,
                         std::pow(points[index].x - p.x, 2) + std::pow(points[index].y - p.y, 2));
      });
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (std::hypot(points[i].x - p.x, points[i].y - p.y) <= radius) {
          expected.insert(static_cast<int>(i));
        }
      }
      EXPECT_EQ(found, expected);
    }
  }
}

TEST(PointGridTest, NoPoints) {
  PointGrid({}, 10).ForEachWithin({0, 0}, 100, [](int, double) { FAIL(); });
}

}  // namespace
}  // namespace flocklift
