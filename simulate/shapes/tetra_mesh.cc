// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/tetra_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace flocklift {
namespace {

constexpr std::array<std::array<int, 2>, 6> kEdges = {
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

}  // namespace

double Volume(const Tetra& t) { return Dot(Cross(t[1] - t[0], t[2] - t[0]), t[3] - t[0]) / 6; }

double ShapeQuality(const Tetra& t) {
  double sum = 0;
  for (const auto& [a, b] : kEdges) sum += SquaredNorm(t[b] - t[a]);
  const double edge = std::sqrt(sum / 6);
  return edge > 0 ? 6 * std::numbers::sqrt2 * Volume(t) / (edge * edge * edge) : 0;
}

double RadiusEdgeRatio(const Tetra& t) {
  const Vec3d b = t[1] - t[0], c = t[2] - t[0], d = t[3] - t[0];
  const double six_volumes = Dot(Cross(b, c), d);
  if (six_volumes == 0) return std::numeric_limits<double>::infinity();
  const Vec3d to_centre =
      (SquaredNorm(b) * Cross(c, d) + SquaredNorm(c) * Cross(d, b) + SquaredNorm(d) * Cross(b, c)) /
      (2 * six_volumes);
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& [i, j] : kEdges) shortest = std::min(shortest, SquaredNorm(t[j] - t[i]));
  return Norm(to_centre) / std::sqrt(shortest);
}

double SmallestDihedral(const Tetra& t) {
  std::array<Vec3d, 4> outwards;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& [a, b, c] = kTetraFaces[k];
    outwards[k] = Normalized(Cross(t[b] - t[a], t[c] - t[a]));
  }
  double smallest = std::numbers::pi;
  for (const auto& [i, j] : kEdges) {
    smallest = std::min(smallest, std::acos(std::clamp(-Dot(outwards[i], outwards[j]), -1., 1.)));
  }
  return smallest;
}

Vec3d Centroid(const Tetra& t) { return 0.25 * (t[0] + t[1] + t[2] + t[3]); }

double BoundingRadius(const Tetra& t) {
  const Vec3d centre = Centroid(t);
  double radius = 0;
  for (const Vec3d& corner : t) radius = std::max(radius, Norm(corner - centre));
  return radius;
}

std::vector<Tetra> Separate(const TetraMesh& mesh) {
  std::vector<Tetra> result;
  result.reserve(mesh.tetrahedra.size());
  for (std::size_t k = 0; k < mesh.tetrahedra.size(); ++k) result.push_back(mesh.Corners(k));
  return result;
}

double Volume(const TetraMesh& mesh) {
  double volume = 0;
  for (std::size_t k = 0; k < mesh.tetrahedra.size(); ++k) volume += Volume(mesh.Corners(k));
  return volume;
}

TriangleMesh Boundary(const TetraMesh& mesh) {
  struct Face {
    std::uint64_t others;  // the two larger of its vertices
    std::uint32_t number;  // 4 tetrahedron + which of its faces
  };
  const std::size_t count = 4 * mesh.tetrahedra.size();
  const auto corners = [&mesh](std::size_t number) {
    std::array<std::uint32_t, 3> vertices{};
    for (std::size_t c = 0; c < 3; ++c) {
      vertices[c] =
          mesh.tetrahedra[number / 4][static_cast<std::size_t>(kTetraFaces[number % 4][c])];
    }
    return vertices;
  };
  // The faces by their smallest vertex: few have the same.
  std::vector<std::uint32_t> first(mesh.vertices.size() + 2);
  std::vector<std::array<std::uint32_t, 3>> sorted(count);
  for (std::size_t k = 0; k < count; ++k) {
    sorted[k] = corners(k);
    std::sort(sorted[k].begin(), sorted[k].end());
    ++first[sorted[k][0] + 2];
  }
  for (std::size_t v = 2; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<Face> faces(count);
  for (std::size_t k = 0; k < count; ++k) {
    faces[first[sorted[k][0] + 1]++] = {std::uint64_t{sorted[k][1]} << 32 | sorted[k][2],
                                        static_cast<std::uint32_t>(k)};
  }
  std::vector<std::uint8_t> is_shared(count);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto begin = faces.begin() + first[v], end = faces.begin() + first[v + 1];
    std::sort(begin, end, [](const Face& a, const Face& b) { return a.others < b.others; });
    for (auto face = begin; end - face > 1; ++face) {
      if (face[0].others != face[1].others) continue;
      is_shared[face[0].number] = is_shared[face[1].number] = 1;
    }
  }
  TriangleMesh boundary{mesh.vertices, {}};
  for (std::size_t k = 0; k < count; ++k) {
    if (is_shared[k] == 0) boundary.triangles.push_back(corners(k));
  }
  return boundary;
}

double EnclosedVolume(const TriangleMesh& surface) {
  double six_volumes = 0;
  for (std::size_t k = 0; k < surface.triangles.size(); ++k) {
    six_volumes += Dot(surface.Corner(k, 0), Cross(surface.Corner(k, 1), surface.Corner(k, 2)));
  }
  return six_volumes / 6;
}

}  // namespace flocklift
