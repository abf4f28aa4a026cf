// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/morph_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flocklift {
namespace {

const std::vector<Vec3d> kPath{{0, 0, 0}, {10, 0, 0}, {10, 20, 0}};  // out along x, in along y

TEST(MorphOrder, ThoseInFrontLeaveFirst) {
  const std::vector<Vec3d> sources{{-1, 5, 0}, {2, 0, 0}, {0, 0, 9}};
  EXPECT_THAT(DepartureOrder(kPath, sources), testing::ElementsAre(1, 2, 0));
}

TEST(MorphOrder, TheFarthestPlacesFillFirst) {
  const std::vector<Vec3d> targets{{9, 19, 0}, {10, 22, 0}, {15, 20, 3}};
  EXPECT_THAT(ArrivalOrder(kPath, targets), testing::ElementsAre(1, 2, 0));
}

TEST(MorphOrder, IsTheOrderOfTheFormula) {
  const std::vector<Vec3d> points{{3, 1, 2}, {-4, 0, 1}, {8, 7, 7}, {0.5, 2, -1}};
  const auto d1 = [](const Vec3d& x) { return Dot(kPath[0] - kPath[1], x - kPath[1]); };
  const auto d2 = [](const Vec3d& x) { return -Dot(kPath[2] - kPath[1], x - kPath[1]); };
  const auto departure = DepartureOrder(kPath, points), arrival = ArrivalOrder(kPath, points);
  for (std::size_t k = 1; k < points.size(); ++k) {
    EXPECT_LE(d1(points[departure[k - 1]]), d1(points[departure[k]]));
    EXPECT_LE(d2(points[arrival[k - 1]]), d2(points[arrival[k]]));
  }
}

TEST(MorphOrder, EqualOnesKeepTheirOrder) {
  const std::vector<Vec3d> points{{1, 3, 0}, {1, 2, 0}, {1, 1, 0}};
  EXPECT_THAT(DepartureOrder(kPath, points), testing::ElementsAre(0, 1, 2));
}

}  // namespace
}  // namespace flocklift
