// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/tetrahedralize.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "simulate/shapes/triangle_tree.h"
#include "tests/simulate/shapes/block_letter.h"

namespace flocklift {
namespace {

// A block letter with convex and concave creases, and corners of both kinds.
TriangleMesh Letter() { return BlockLetter({{0, 0}, {1, 0}, {2, 0}, {0, 1}, {0, 2}, {1, 2}}, 0.8); }

void ExpectConforming(const TetraMesh& mesh) {
  std::map<std::array<std::uint32_t, 3>, int> uses;
  for (const auto& t : mesh.tetrahedra) {
    for (const auto& [a, b, c] : kTetraFaces) {
      std::array<std::uint32_t, 3> face{t[static_cast<std::size_t>(a)],
                                        t[static_cast<std::size_t>(b)],
                                        t[static_cast<std::size_t>(c)]};
      std::sort(face.begin(), face.end());
      ++uses[face];
    }
  }
  for (const auto& [face, count] : uses) EXPECT_LE(count, 2);
  // What one tetrahedron has alone is a closed surface: every edge of it both ways, equally often.
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const auto& face : Boundary(mesh).triangles) {
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint32_t a = face[e], b = face[(e + 1) % 3];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  for (const auto& [edge, sum] : balance) EXPECT_EQ(sum, 0);
}

// The greatest distance of a point of `a` (its corners, centres and edges' middles) from `b`.
double FarthestFrom(const TriangleMesh& a, const TriangleMesh& b) {
  const TriangleTree tree(b);
  double farthest = 0;
  for (std::size_t t = 0; t < a.triangles.size(); ++t) {
    for (int i = 0; i <= 6; ++i) {
      for (int j = 0; i + j <= 6; ++j) {
        const Vec3d p = a.Corner(t, 0) + i / 6.0 * (a.Corner(t, 1) - a.Corner(t, 0)) +
                        j / 6.0 * (a.Corner(t, 2) - a.Corner(t, 0));
        farthest = std::max(farthest, tree.NearestPoint(p).squared_distance);
      }
    }
  }
  return std::sqrt(farthest);
}

struct Quality {
  double least = 1, least_dihedral = 4, within_ratio = 0;
};
Quality QualityOf(const TetraMesh& mesh) {
  Quality q;
  for (std::size_t k = 0; k < mesh.tetrahedra.size(); ++k) {
    const Tetra t = mesh.Corners(k);
    q.least = std::min(q.least, ShapeQuality(t));
    q.least_dihedral = std::min(q.least_dihedral, SmallestDihedral(t));
    q.within_ratio += RadiusEdgeRatio(t) <= 2 ? 1 : 0;
  }
  q.within_ratio /= static_cast<double>(mesh.tetrahedra.size());
  return q;
}

void Record(const char* name, const TriangleMesh& surface, const TetraMesh& mesh, double cell) {
  const Quality q = QualityOf(mesh);
  const TriangleMesh boundary = Boundary(mesh);
  testing::Test::RecordProperty(
      name, std::to_string(mesh.tetrahedra.size()) + " tetrahedra, volume error " +
                std::to_string(Volume(mesh) / EnclosedVolume(surface) - 1) + ", Hausdorff/cell " +
                std::to_string(FarthestFrom(boundary, surface) / cell) + " " +
                std::to_string(FarthestFrom(surface, boundary) / cell) + ", quality " +
                std::to_string(q.least) + ", dihedral " +
                std::to_string(q.least_dihedral * 180 / std::numbers::pi) + ", within ratio 2 " +
                std::to_string(q.within_ratio));
}

TEST(Tetrahedralize, ALetterKeepsItsCreases) {
  const TriangleMesh letter = Letter();
  const double cell = 0.31;
  const TetraMesh mesh = Tetrahedralize(letter, {.cell = cell});
  Record("letter", letter, mesh, cell);
  ExpectConforming(mesh);
  EXPECT_GT(QualityOf(mesh).least, 0);
  EXPECT_NEAR(Volume(mesh), EnclosedVolume(letter), 1e-3 * EnclosedVolume(letter));
  EXPECT_LT(FarthestFrom(Boundary(mesh), letter), 0.2 * cell);  // one concave crease is met late
  EXPECT_LT(FarthestFrom(letter, Boundary(mesh)), 0.1 * cell);
}

TEST(Tetrahedralize, ABallIsRound) {
  const TriangleMesh ball = Ball(1, 24);
  const double cell = 0.25;
  const TetraMesh mesh = Tetrahedralize(ball, {.cell = cell});
  Record("ball", ball, mesh, cell);
  ExpectConforming(mesh);
  EXPECT_NEAR(Volume(mesh), EnclosedVolume(ball), 0.02 * EnclosedVolume(ball));
  EXPECT_LT(FarthestFrom(Boundary(mesh), ball), 0.1 * cell);
  EXPECT_LT(FarthestFrom(ball, Boundary(mesh)), 0.1 * cell);
}

TEST(Tetrahedralize, TetrahedraAreWellShaped) {
  for (const TriangleMesh& surface : {Letter(), Ball(1.2, 20)}) {
    const Quality q = QualityOf(Tetrahedralize(surface, {.cell = 0.27}));
    EXPECT_GT(q.least, 0.1);
    EXPECT_GT(q.least_dihedral, 5 * std::numbers::pi / 180);
    EXPECT_GT(q.within_ratio, 0.995);
  }
}

TEST(Tetrahedralize, TheCountComesNearWhatIsAskedFor) {
  for (const int most : {700, 3000}) {
    const TetraMesh mesh = Tetrahedralize(Letter(), {.most_tetrahedra = most});
    EXPECT_LE(mesh.tetrahedra.size(), static_cast<std::size_t>(most));
    EXPECT_GE(mesh.tetrahedra.size(), static_cast<std::size_t>(0.9 * most));
  }
}

TEST(Tetrahedralize, MovesWithTheSurface) {
  TriangleMesh ball = Ball(1, 10);
  const TetraMesh before = Tetrahedralize(ball, {.cell = 0.5});
  for (Vec3d& p : ball.vertices) p += Vec3d{4, -8, 2};
  const TetraMesh after = Tetrahedralize(ball, {.cell = 0.5});
  EXPECT_EQ(before.tetrahedra, after.tetrahedra);
  for (std::size_t k = 0; k < before.vertices.size(); ++k) {
    EXPECT_LT(Norm(before.vertices[k] + Vec3d{4, -8, 2} - after.vertices[k]), 1e-6);
  }
}

TEST(Tetrahedralize, OverlappingPartsAreOneSolid) {
  TriangleMesh two = BlockLetter({{0, 0}}, 1);
  const TriangleMesh other = two;
  for (const Vec3d& p : other.vertices) two.vertices.push_back(p + Vec3d{0.5, 0, 0});
  for (auto triangle : other.triangles) {
    for (std::uint32_t& corner : triangle) corner += 8;
    two.triangles.push_back(triangle);
  }
  const TetraMesh mesh = Tetrahedralize(two, {.cell = 0.15});
  EXPECT_NEAR(Volume(mesh), 1.5, 0.03);
}

TEST(Tetrahedralize, RefusesWhatEnclosesNothing) {
  TriangleMesh inside_out = Letter();
  for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
  EXPECT_THROW(Tetrahedralize(inside_out, {}), std::invalid_argument);
}

TEST(Tetrahedralize, TetgenIsThereOrSaysThatItIsNot) {
  if (!HasTetgen()) {
    EXPECT_THROW(Tetrahedralize(Letter(), {.tetgen = true}), std::invalid_argument);
    return;
  }
  const TetraMesh mesh = Tetrahedralize(Letter(), {.cell = 0.3, .tetgen = true});
  Record("tetgen", Letter(), mesh, 0.3);
  ExpectConforming(mesh);
  EXPECT_NEAR(Volume(mesh), EnclosedVolume(Letter()), 1e-9);
  EXPECT_EQ(QualityOf(mesh).within_ratio, 1);
}

}  // namespace
}  // namespace flocklift
