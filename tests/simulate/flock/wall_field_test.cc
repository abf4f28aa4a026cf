// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/wall_field.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "simulate/shapes/solid_meshes.h"

namespace flocklift {
namespace {

World Room() {
  World world;
  world.box = {{0, 0, 0}, {4, 3, 2}};
  world.obstacles = {{BoxMesh({1, 1, 0}, {2, 2, 2}), Block{{1, 1, 0}, {2, 2, 2}}}};
  return world;
}

TEST(WallField, IsTheNearerOfBoxAndObstacles) {
  const ScalarField field = WallField(Room(), 0.25, 1);
  EXPECT_EQ(field.grid.low, (Vec3d{-0.25, -0.25, -0.25}));
  EXPECT_EQ(field.grid.High(), (Vec3d{4.25, 3.25, 2.25}));
  for (std::size_t node = 0; node < field.grid.size(); ++node) {
    const Vec3d p = field.grid.Node(node);
    const double box =
        std::min({p.x, 4 - p.x, p.y, 3 - p.y, p.z, 2 - p.z});  // negative beyond the box
    EXPECT_NEAR(field.values[node], std::min(box, Block{{1, 1, 0}, {2, 2, 2}}(p)), 1e-6);
  }
  EXPECT_NEAR(field.Sample({3, 1.5, 1}), 1, 1e-6);       // from the box and from the obstacle
  EXPECT_NEAR(field.Sample({1.5, 1.5, 1}), -0.5, 1e-6);  // in the obstacle
  EXPECT_NEAR(field.Sample({3, 1.5, 0}), 0, 1e-6);       // on the floor
}

TEST(WallField, TheGroundHasNeitherFloorNorCeiling) {
  const ScalarField field = WallField(Room(), 0.25, 1, 0.1);
  EXPECT_EQ(field.grid.nz, 1);
  EXPECT_EQ(field.grid.low, (Vec3d{-0.25, -0.25, 0.1}));
  EXPECT_NEAR(field.Sample({3, 1.5, 0.1}), 1, 1e-6);
  EXPECT_NEAR(field.Sample({1.5, 1.5, 0.1}), -0.1, 1e-6);  // to the obstacle's own foot
  EXPECT_NEAR(field.Sample({-0.25, 1, 0.1}), -0.25, 1e-6);
}

TEST(WallField, TheSameBytesAtAnyThreadCountAndNoneWithoutABox) {
  EXPECT_EQ(WallField(Room(), 0.1, 1).values, WallField(Room(), 0.1, 2).values);
  World boundless;
  EXPECT_THROW(WallField(boundless, 0.1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
