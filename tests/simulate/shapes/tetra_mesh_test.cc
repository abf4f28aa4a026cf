// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/tetra_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/simulate/shapes/block_letter.h"

namespace flocklift {
namespace {

const Tetra kCorner{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
const Tetra kRegular{{{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}}};

TEST(Tetra, TheCornerOfACubeByHand) {
  EXPECT_NEAR(Volume(kCorner), 1.0 / 6, 1e-15);
  EXPECT_NEAR(RadiusEdgeRatio(kCorner), std::sqrt(3.0) / 2, 1e-12);  // the cube's centre
  EXPECT_NEAR(SmallestDihedral(kCorner), std::acos(1 / std::sqrt(3.0)), 1e-12);
  EXPECT_NEAR(Norm(Centroid(kCorner) - Vec3d{0.25, 0.25, 0.25}), 0, 1e-15);
  EXPECT_NEAR(BoundingRadius(kCorner), std::sqrt(0.75 * 0.75 + 2 * 0.25 * 0.25), 1e-15);
}

TEST(Tetra, TheRegularOneHasQualityOne) {
  const double sign = Volume(kRegular) > 0 ? 1 : -1;
  EXPECT_NEAR(ShapeQuality(kRegular), sign, 1e-12);
  EXPECT_NEAR(RadiusEdgeRatio(kRegular), std::sqrt(6.0) / 4, 1e-12);
}

TEST(Tetra, InsideOutIsNegative) {
  Tetra t = kCorner;
  std::swap(t[0], t[1]);
  EXPECT_NEAR(Volume(t), -1.0 / 6, 1e-15);
  EXPECT_LT(ShapeQuality(t), 0);
}

TEST(TetraMesh, BoundaryOfTwoFacesOutwards) {
  const TetraMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}},
                       {{0, 1, 2, 3}, {0, 2, 1, 4}}};
  const TriangleMesh boundary = Boundary(mesh);
  EXPECT_EQ(boundary.triangles.size(), 6u);
  EXPECT_NEAR(EnclosedVolume(boundary), 2.0 / 6, 1e-15);
  EXPECT_NEAR(Volume(mesh), 2.0 / 6, 1e-15);
}

TEST(EnclosedVolume, OfALetterOfBlocks) {
  EXPECT_NEAR(EnclosedVolume(BlockLetter({{0, 0}, {1, 0}, {1, 1}}, 0.5)), 1.5, 1e-12);
}

}  // namespace
}  // namespace flocklift
