// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/surface_walk.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace flocklift::internal {
namespace {

using Barycentric = std::array<double, 3>;

// Change of the barycentric coordinates along a way in the plane of the triangle a, a + e1, a + e2.
Barycentric RatesAlong(const Vec3d& e1, const Vec3d& e2, const Vec3d& way) {
  const double g11 = Dot(e1, e1), g12 = Dot(e1, e2), g22 = Dot(e2, e2);
  const double w1 = Dot(e1, way), w2 = Dot(e2, way);
  const double determinant = g11 * g22 - g12 * g12;
  const double u = (g22 * w1 - g12 * w2) / determinant;
  const double v = (g11 * w2 - g12 * w1) / determinant;
  return {-u - v, u, v};
}

SurfaceSample Clean(std::uint32_t triangle, const Barycentric& b) {
  const double u = std::max(0.0, b[1]), v = std::max(0.0, b[2]);
  const double excess = std::max(1.0, u + v);
  return {triangle, u / excess, v / excess};
}

}  // namespace

SurfaceWalk::SurfaceWalk(const TriangleMesh& mesh)
    : mesh_(mesh), across_(mesh.triangles.size(), {kNone, kNone, kNone}) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::uint32_t, std::size_t>> open;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3d& a = mesh.Corner(t, 0);
    normal_.push_back(Normalized(Cross(mesh.Corner(t, 1) - a, mesh.Corner(t, 2) - a)));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t p = mesh.triangles[t][(k + 1) % 3], q = mesh.triangles[t][(k + 2) % 3];
      const auto [entry, is_new] = open.try_emplace(std::minmax(p, q), t, k);
      if (is_new) continue;
      const auto [other, side] = entry->second;
      across_[t][k] = other;
      across_[other][side] = t;
      open.erase(entry);
    }
  }
}

SurfaceSample SurfaceWalk::Go(const SurfaceSample& start, const Vec3d& way) const {
  constexpr int kMostEdges = 1000;
  std::uint32_t t = start.triangle;
  Barycentric at{1 - start.u - start.v, start.u, start.v};
  Vec3d left = way - Dot(way, normal_[t]) * normal_[t];
  for (int crossed = 0; crossed < kMostEdges; ++crossed) {
    const Vec3d& a = mesh_.Corner(t, 0);
    if (normal_[t] == Vec3d{}) break;
    const Barycentric rate = RatesAlong(mesh_.Corner(t, 1) - a, mesh_.Corner(t, 2) - a, left);
    double share = 1;
    std::size_t exit = 3;
    for (std::size_t k = 0; k < 3; ++k) {
      if (rate[k] < 0 && at[k] + share * rate[k] < 0) {
        share = std::max(0.0, at[k] / -rate[k]);
        exit = k;
      }
    }
    for (std::size_t k = 0; k < 3; ++k) at[k] += share * rate[k];
    if (exit == 3 || across_[t][exit] == kNone) break;

    // Over the edge (p, q): what runs along it stays, what crosses it goes on in the next plane.
    const std::uint32_t p = mesh_.triangles[t][(exit + 1) % 3];
    const std::uint32_t next = across_[t][exit];
    if (normal_[next] == Vec3d{}) break;
    const double share_of_p = std::clamp(
        at[(exit + 1) % 3] / std::max(1e-300, at[(exit + 1) % 3] + at[(exit + 2) % 3]), 0.0, 1.0);
    const std::size_t corner = static_cast<std::size_t>(
        std::find(across_[next].begin(), across_[next].end(), t) - across_[next].begin());
    const std::size_t i = (corner + 1) % 3, j = (corner + 2) % 3;
    const Vec3d edge = Normalized(mesh_.Corner(next, j) - mesh_.Corner(next, i));
    const Vec3d to_corner = mesh_.Corner(next, corner) - mesh_.Corner(next, i);
    const Vec3d inwards = Normalized(to_corner - Dot(to_corner, edge) * edge);
    const Vec3d rest = (1 - share) * left;
    const double along = Dot(rest, edge);
    left = along * edge + std::sqrt(std::max(0.0, SquaredNorm(rest) - along * along)) * inwards;
    const bool i_is_p = mesh_.triangles[next][i] == p;
    at = {};
    at[i] = i_is_p ? share_of_p : 1 - share_of_p;
    at[j] = 1 - at[i];
    t = next;
  }
  return Clean(t, at);
}

}  // namespace flocklift::internal
