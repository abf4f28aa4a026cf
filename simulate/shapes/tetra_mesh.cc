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
    std::array<std::uint32_t, 3> sorted;
    std::uint32_t tetra, number;
  };
  std::vector<Face> faces;
  faces.reserve(4 * mesh.tetrahedra.size());
  for (std::uint32_t k = 0; k < mesh.tetrahedra.size(); ++k) {
    for (std::uint32_t f = 0; f < 4; ++f) {
      Face face{{}, k, f};
      for (std::size_t c = 0; c < 3; ++c) {
        face.sorted[c] = mesh.tetrahedra[k][static_cast<std::size_t>(kTetraFaces[f][c])];
      }
      std::sort(face.sorted.begin(), face.sorted.end());
      faces.push_back(face);
    }
  }
  std::stable_sort(faces.begin(), faces.end(),
                   [](const Face& a, const Face& b) { return a.sorted < b.sorted; });
  std::vector<Face> single;
  for (std::size_t k = 0; k < faces.size();) {
    std::size_t end = k + 1;
    while (end < faces.size() && faces[end].sorted == faces[k].sorted) ++end;
    if (end == k + 1) single.push_back(faces[k]);
    k = end;
  }
  std::sort(single.begin(), single.end(), [](const Face& a, const Face& b) {
    return std::pair(a.tetra, a.number) < std::pair(b.tetra, b.number);
  });
  TriangleMesh boundary{mesh.vertices, {}};
  for (const Face& face : single) {
    const auto& corners = kTetraFaces[face.number];
    const auto& t = mesh.tetrahedra[face.tetra];
    boundary.triangles.push_back({t[static_cast<std::size_t>(corners[0])],
                                  t[static_cast<std::size_t>(corners[1])],
                                  t[static_cast<std::size_t>(corners[2])]});
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
