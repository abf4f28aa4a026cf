// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/mesh_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "simulate/fields/solids.h"
#include "tests/simulate/fields/meshes.h"

namespace flocklift {
namespace {

double ToSegment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const double t = std::clamp(Dot(p - a, b - a) / SquaredNorm(b - a), 0.0, 1.0);
  return Norm(p - (a + t * (b - a)));
}

// Over every triangle: its plane where the foot is on the inner side of all three sides, and the
// sides in any case.
double BruteDistance(const TriangleMesh& mesh, const Vec3d& p) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3d &a = mesh.Corner(t, 0), &b = mesh.Corner(t, 1), &c = mesh.Corner(t, 2);
    best = std::min({best, ToSegment(p, a, b), ToSegment(p, b, c), ToSegment(p, c, a)});
    const Vec3d n = Normalized(Cross(b - a, c - a));
    if (Dot(n, Cross(b - a, p - a)) >= 0 && Dot(n, Cross(c - b, p - b)) >= 0 &&
        Dot(n, Cross(a - c, p - c)) >= 0) {
      best = std::min(best, std::abs(Dot(n, p - a)));
    }
  }
  return best;
}

// Whether p is inside, by the solid angle under which the surface is seen (4 pi inside).
bool BruteInside(const TriangleMesh& mesh, const Vec3d& p) {
  double angle = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3d a = mesh.Corner(t, 0) - p, b = mesh.Corner(t, 1) - p, c = mesh.Corner(t, 2) - p;
    const double na = Norm(a), nb = Norm(b), nc = Norm(c);
    angle += 2 * std::atan2(Dot(a, Cross(b, c)),
                            na * nb * nc + Dot(a, b) * nc + Dot(b, c) * na + Dot(c, a) * nb);
  }
  return angle > 2 * std::numbers::pi;
}

// Points all around, points very near to faces, and points that see a vertex or an edge first.
std::vector<Vec3d> Probes(const TriangleMesh& mesh, int count) {
  std::vector<Vec3d> probes;
  Rng rng(5);
  const auto direction = [&rng] {
    return Normalized(Vec3d{rng.Normal(), rng.Normal(), rng.Normal()});
  };
  for (int k = 0; k < count; ++k) {
    probes.push_back({rng.Uniform(-2.5, 2.5), rng.Uniform(-2.5, 2.5), rng.Uniform(-3, 3.5)});
    const std::size_t t = rng.Below(static_cast<std::uint32_t>(mesh.triangles.size()));
    const Vec3d &a = mesh.Corner(t, 0), &b = mesh.Corner(t, 1), &c = mesh.Corner(t, 2);
    const double step = std::pow(10, rng.Uniform(-6, -0.5));
    const double u = rng.Uniform(), v = rng.Uniform() * (1 - u);
    probes.push_back(a + u * (b - a) + v * (c - a) + step * direction());
    probes.push_back(a + step * direction());
    probes.push_back(a + u * (b - a) + step * direction());
  }
  return probes;
}

TEST(MeshDistance, AgreesWithBruteForce) {
  for (const NamedMesh& mesh : ManyMeshes()) {
    const MeshDistance distance(mesh.mesh);
    int inside = 0, outside = 0;
    std::uint32_t hint = 0;
    for (const Vec3d& p : Probes(mesh.mesh, 500)) {
      const SurfacePoint found = distance.Closest(p, hint);
      hint = found.triangle;
      EXPECT_NEAR(std::abs(found.distance), BruteDistance(mesh.mesh, p), 1e-12) << mesh.name;
      EXPECT_NEAR(Norm(p - found.position), std::abs(found.distance), 1e-12) << mesh.name;
      EXPECT_NEAR(Norm(found.normal), 1, 1e-12) << mesh.name;
      // A hint may change which of several equally near triangles is named, no more.
      EXPECT_NEAR(std::abs(distance(p)), std::abs(found.distance), 1e-14) << mesh.name;
      if (std::abs(found.distance) < 1e-9) continue;  // on the surface: either sign
      const bool is_inside = BruteInside(mesh.mesh, p);
      ++(is_inside ? inside : outside);
      EXPECT_EQ(found.distance < 0, is_inside)
          << mesh.name << " " << p.x << " " << p.y << " " << p.z << " " << found.distance;
    }
    EXPECT_GT(inside, 40) << mesh.name;
    EXPECT_GT(outside, 40) << mesh.name;
  }
}

TEST(MeshDistance, TheCubeByHand) {
  const MeshDistance cube(BoxMesh({-1, -1, -1}, {1, 1, 1}));
  EXPECT_DOUBLE_EQ(cube({0, 0, 0}), -1);
  EXPECT_DOUBLE_EQ(cube({0.25, 0, 3}), 2);
  EXPECT_DOUBLE_EQ(cube({2, 2, 0.1}), std::sqrt(2.0));  // beyond an edge
  EXPECT_DOUBLE_EQ(cube({-2, 2, -2}), std::sqrt(3.0));  // beyond a corner
  EXPECT_DOUBLE_EQ(cube({0.5, 0.5, 0.75}), -0.25);
  const SurfacePoint corner = cube.Closest({2, 3, 4});
  EXPECT_EQ(corner.position, (Vec3d{1, 1, 1}));
  // Three right angles: the weighted normal of a cube's corner is its diagonal, however the
  // faces are cut into triangles.
  for (const double part : {corner.normal.x, corner.normal.y, corner.normal.z}) {
    EXPECT_NEAR(part, 1 / std::sqrt(3.0), 1e-14);
  }
  EXPECT_EQ(cube.low(), (Vec3d{-1, -1, -1}));
  EXPECT_EQ(cube.high(), (Vec3d{1, 1, 1}));
}

TEST(MeshDistance, BoxesHaveTheirClosedForm) {
  for (const double thin : {1.0, 1e-2, 1e-5}) {
    const Vec3d low{-0.7, -1.1, -0.2}, high{0.4, 0.9, -0.2 + thin};
    const MeshDistance mesh(BoxMesh(low, high));
    const Block block{low, high};
    for (const Vec3d& p : Probes(BoxMesh(low, high), 500)) EXPECT_NEAR(mesh(p), block(p), 1e-12);
  }
}

TEST(MeshDistance, AFineBallNearsTheRoundOne) {
  double last = 1;
  for (const std::uint32_t parallels : {8u, 16u, 32u, 64u}) {
    const MeshDistance mesh(BallMesh({0, 0, 0}, 1, parallels, 2 * parallels));
    double worst = 0;
    Rng rng(7);
    for (int k = 0; k < 400; ++k) {
      const Vec3d p{rng.Uniform(-2, 2), rng.Uniform(-2, 2), rng.Uniform(-2, 2)};
      worst = std::max(worst, std::abs(mesh(p) - (Norm(p) - 1)));
    }
    EXPECT_LT(worst, 0.35 * last);  // quadratic in the edge
    last = worst;
  }
  EXPECT_LT(last, 3e-3);
}

TEST(MeshDistance, MovesWithTheMesh) {
  const TriangleMesh mesh = BallMesh({0, 0, 0}, 1, 9, 13, 0.3);
  TriangleMesh moved = mesh;
  const auto move = [](const Vec3d& p) {  // a turn by 90 degrees and a shift
    return Vec3d{-p.y, p.x, p.z} + Vec3d{3, -2, 1};
  };
  for (Vec3d& vertex : moved.vertices) vertex = move(vertex);
  std::reverse(moved.triangles.begin(), moved.triangles.end());
  const MeshDistance here(mesh), there(moved);
  for (const Vec3d& p : Probes(mesh, 300)) EXPECT_NEAR(here(p), there(move(p)), 1e-12);
}

TEST(MeshDistance, AnOpenMeshHasNoSign) {
  TriangleMesh mesh = BoxMesh({0, 0, 0}, {1, 1, 1});
  mesh.triangles.pop_back();
  EXPECT_THROW(MeshDistance{mesh}, std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
