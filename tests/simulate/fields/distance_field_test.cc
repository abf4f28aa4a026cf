// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/distance_field.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/simulate/fields/meshes.h"

namespace flocklift {
namespace {

// A crowded scene: meshes that overlap, and solids of every kind.
std::vector<Solid> Village() {
  std::vector<Solid> solids;
  for (NamedMesh& named : ManyMeshes()) {
    for (Vec3d& v : named.mesh.vertices) v += {1.3 * static_cast<double>(solids.size()), 0.5, 0};
    solids.emplace_back(MeshDistance(named.mesh));
  }
  solids.emplace_back(Ball{{2, 3, 0}, 0.7});
  solids.emplace_back(Block{{4, -3, -1}, {5, -1, 1}});
  solids.emplace_back(Capsule{{7, 2, -1}, {9, 3, 1}, 0.3});
  solids.emplace_back(Cylinder{{8, -3, -2}, {8, -3, 2}, 0.4});
  return solids;
}

const Grid kGrid = GridOver({-3, -4, -3}, {13, 5, 3}, 0.4);

TEST(DistanceField, HoldsTheExactDistanceAtEveryNode) {
  const std::vector<Solid> solids = Village();
  const ScalarField field = DistanceField(kGrid, solids);
  int inside = 0;
  for (std::size_t k = 0; k < kGrid.size(); ++k) {
    const double expected = SignedDistance(solids, kGrid.Node(k));
    inside += expected < 0;
    ASSERT_NEAR(field.values[k], expected, 1e-6 * (1 + std::abs(expected))) << k;
  }
  EXPECT_GT(inside, 200);
}

TEST(DistanceField, TheSameBytesAtAnyThreadCount) {
  const std::vector<Solid> solids = Village();
  const ScalarField one = DistanceField(kGrid, solids, 1);
  EXPECT_EQ(one.values, DistanceField(kGrid, solids, 2).values);
  EXPECT_EQ(one.values, DistanceField(kGrid, solids, 5).values);
}

TEST(DistanceField, NoObstacleIsFarAway) {
  const ScalarField field = DistanceField({{0, 0, 0}, 1, 3, 4, 5}, {});
  EXPECT_EQ(field.values, std::vector<float>(60, kNoObstacle));
}

}  // namespace
}  // namespace flocklift
