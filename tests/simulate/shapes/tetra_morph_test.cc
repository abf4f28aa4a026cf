// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/tetra_morph.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

Tetra RandomTetra(Rng* rng) {
  for (;;) {
    Tetra t;
    for (Vec3d& p : t) p = {rng->Normal(), rng->Normal(), rng->Normal()};
    if (Volume(t) < 0) std::swap(t[0], t[1]);
    if (ShapeQuality(t) > 0.02) return t;
  }
}

Eigen::Matrix3d ToEigen(const glm::dmat3& m) {
  Eigen::Matrix3d result;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) result(row, column) = m[column][row];
  }
  return result;
}

TEST(PolarDecompose, EqualsTheSingularValueDecomposition) {
  Rng rng(11);
  for (int k = 0; k < 300; ++k) {
    const glm::dmat3 a = AffineBetween(RandomTetra(&rng), RandomTetra(&rng));
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(ToEigen(a),
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
    const Eigen::Matrix3d stretch =
        svd.matrixV() * svd.singularValues().asDiagonal() * svd.matrixV().transpose();
    const PolarFactors factors = PolarDecompose(a);
    const double size = svd.singularValues()(0);
    EXPECT_LT((ToEigen(factors.rotation) - rotation).norm(),
              1e-11 * size / svd.singularValues()(2));
    EXPECT_LT((ToEigen(factors.stretch) - stretch).norm(), 1e-11 * size);
    EXPECT_NEAR(glm::determinant(factors.rotation), 1, 1e-12);
  }
}

TEST(PolarDecompose, AQuarterTurnAndAStretchByHand) {
  const glm::dmat3 turn{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};  // columns
  const glm::dmat3 stretch{{2, 0, 0}, {0, 3, 0}, {0, 0, 0.5}};
  const PolarFactors factors = PolarDecompose(turn * stretch);
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      EXPECT_NEAR(factors.rotation[c][r], turn[c][r], 1e-13);
      EXPECT_NEAR(factors.stretch[c][r], stretch[c][r], 1e-13);
    }
  }
}

class TetraMorphKinds : public testing::TestWithParam<MorphKind> {};
INSTANTIATE_TEST_SUITE_P(Both, TetraMorphKinds,
                         testing::Values(MorphKind::kPublished, MorphKind::kShoemake));

TEST_P(TetraMorphKinds, StartsAtTheSourceAndEndsAtTheTarget) {
  Rng rng(13);
  for (int k = 0; k < 300; ++k) {
    const Tetra from = RandomTetra(&rng), to = RandomTetra(&rng);
    const Tetra first = TetraBetween(from, to, 0, GetParam());
    const Tetra last = TetraBetween(from, to, 1, GetParam());
    for (std::size_t c = 0; c < 4; ++c) {
      EXPECT_LT(Norm(first[c] - from[c]), 1e-12);
      EXPECT_LT(Norm(last[c] - to[c]), 1e-12 * std::max(1.0, BoundingRadius(to)) * 10);
    }
  }
}

TEST_P(TetraMorphKinds, ARotationOnlyTurnsTheTetrahedron) {
  Rng rng(17);
  const Tetra from = RandomTetra(&rng);
  Tetra to;
  for (std::size_t c = 0; c < 4; ++c) to[c] = {-from[c].y, from[c].x, from[c].z};  // 90 deg about z
  const TetraMorph morph(from, to);
  EXPECT_NEAR(morph.angle, std::acos(0.0), 1e-12);
  EXPECT_NEAR(morph.axis.z, 1, 1e-12);
  if (GetParam() == MorphKind::kShoemake) {  // the published one loses volume between, as printed
    for (const double t : {0.2, 0.5, 0.9}) {
      EXPECT_NEAR(Volume(TetraBetween(from, to, t, GetParam())), Volume(from), 1e-12);
    }
  }
}

TEST(TetraMorph, ShoemakesNeverTurnsInsideOut) {
  Rng rng(19);
  for (int k = 0; k < 200; ++k) {
    const Tetra from = RandomTetra(&rng), to = RandomTetra(&rng);
    for (int s = 0; s <= 20; ++s) {
      EXPECT_GT(Volume(TetraBetween(from, to, s / 20.0, MorphKind::kShoemake)), 0);
    }
  }
}

TEST(MatchCorners, UndoesAnyOrderOfTheSameOrientation) {
  Rng rng(23);
  for (int k = 0; k < 50; ++k) {
    const Tetra from = RandomTetra(&rng);
    const Tetra shuffled{from[2], from[0], from[1], from[3]};
    const Tetra matched = MatchCorners(from, shuffled);
    for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(matched[c], from[c]);
  }
}

TEST(MatchCorners, KeepsTheOrientationAndTurnsLess) {
  Rng rng(29);
  double before = 0, after = 0;
  for (int k = 0; k < 100; ++k) {
    const Tetra from = RandomTetra(&rng), to = RandomTetra(&rng);
    const Tetra matched = MatchCorners(from, to);
    EXPECT_GT(Volume(matched), 0);
    before += TetraMorph(from, to).angle;
    after += TetraMorph(from, matched).angle;
  }
  EXPECT_LT(after, 0.7 * before);
}

}  // namespace
}  // namespace flocklift
