// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/body_centred_lattice.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>

namespace flocklift {
namespace {

TriangleMesh Octahedron() {  // |x| + |y| + |z| <= 1
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

TEST(BodyCentredLattice, PointsInsideAnOctahedronAreThoseOfItsFormula) {
  const TriangleMesh surface = Octahedron();
  const BodyCentredLattice lattice(surface, 0.13);
  const std::vector<signed char> signs = SignsOn(lattice, surface);
  ASSERT_EQ(signs.size(), lattice.size());
  std::array<int, 2> inside{};
  for (int kind = 0; kind < 2; ++kind) {
    for (int k = 0; k < lattice.cells(2) + 1 - kind; ++k) {
      for (int j = 0; j < lattice.cells(1) + 1 - kind; ++j) {
        for (int i = 0; i < lattice.cells(0) + 1 - kind; ++i) {
          const Vec3d p = lattice.LineStart(kind, i, j) + Vec3d{0, 0, k * lattice.cell()};
          const bool in = std::abs(p.x) + std::abs(p.y) + std::abs(p.z) < 1;
          EXPECT_EQ(signs[lattice.Point(kind, i, j, k)], in ? 1 : -1) << p.x << ' ' << p.y;
          inside[static_cast<std::size_t>(kind)] += in ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(inside[0], 0);
  EXPECT_GT(inside[1], 0);
}

TEST(BodyCentredLattice, TellsLongEdgesFromShortOnes) {
  const BodyCentredLattice lattice(Octahedron(), 0.5);
  EXPECT_TRUE(lattice.IsLong(lattice.Corner(0, 0, 0), lattice.Corner(1, 0, 0)));
  EXPECT_TRUE(lattice.IsLong(lattice.Centre(0, 0, 0), lattice.Centre(0, 1, 0)));
  EXPECT_FALSE(lattice.IsLong(lattice.Corner(0, 0, 0), lattice.Centre(0, 0, 0)));
}

TEST(BodyCentredLattice, RefusesTooManyCells) {
  EXPECT_THROW(BodyCentredLattice(Octahedron(), 1e-4), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
