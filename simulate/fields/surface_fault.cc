// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/surface_fault.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace flocklift {
namespace {

// A side of a triangle, from one vertex to the next.
struct HalfEdge {
  std::uint32_t low, high;  // its vertices by number
  std::uint32_t from;       // the one it starts at

  bool SameEdge(const HalfEdge& b) const { return low == b.low && high == b.high; }
};

std::string EdgeName(const HalfEdge& edge) {
  return "the edge between vertices " + std::to_string(edge.low) + " and " +
         std::to_string(edge.high);
}

std::optional<std::string> CornerFault(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return "there is no triangle";
  for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
    const Vec3d& v = mesh.vertices[k];
    if (!std::isfinite(v.x + v.y + v.z)) {
      return "vertex " + std::to_string(k) + " is not finite";
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::string name = "triangle " + std::to_string(t);
    for (const std::uint32_t corner : mesh.triangles[t]) {
      if (corner >= mesh.vertices.size()) {
        return name + " names vertex " + std::to_string(corner) + ", which does not exist";
      }
    }
    const Vec3d ab = mesh.Corner(t, 1) - mesh.Corner(t, 0);
    const Vec3d ac = mesh.Corner(t, 2) - mesh.Corner(t, 0);
    const double longest = std::max({SquaredNorm(ab), SquaredNorm(ac), SquaredNorm(ac - ab)});
    if (!(Norm(Cross(ab, ac)) > 1e-12 * longest)) return name + " has no area";
  }
  return std::nullopt;
}

std::optional<std::string> EdgeFault(const TriangleMesh& mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t from = triangle[c], to = triangle[(c + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), from});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::array{a.low, a.high, a.from} < std::array{b.low, b.high, b.from};
  });
  for (std::size_t k = 0; k < edges.size();) {
    std::size_t end = k + 1;
    while (end < edges.size() && edges[end].SameEdge(edges[k])) ++end;
    if (end - k == 1) return EdgeName(edges[k]) + " belongs to one triangle only";
    if (end - k > 2) {
      return EdgeName(edges[k]) + " belongs to " + std::to_string(end - k) + " triangles";
    }
    if (edges[k].from == edges[k + 1].from) {
      return "two triangles run along " + EdgeName(edges[k]) + " in the same direction";
    }
    k = end;
  }
  return std::nullopt;
}

std::optional<std::string> VolumeFault(const TriangleMesh& mesh) {
  double six_volumes = 0;
  const Vec3d origin = mesh.Corner(0, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    six_volumes += Dot(mesh.Corner(t, 0) - origin,
                       Cross(mesh.Corner(t, 1) - origin, mesh.Corner(t, 2) - origin));
  }
  if (six_volumes > 0) return std::nullopt;
  return "the surface is inside out (its volume is not positive)";
}

}  // namespace

std::optional<std::string> SurfaceFault(const TriangleMesh& mesh) {
  for (const auto& fault_of : {CornerFault, EdgeFault, VolumeFault}) {
    if (const auto fault = fault_of(mesh)) return fault;
  }
  return std::nullopt;
}

}  // namespace flocklift
