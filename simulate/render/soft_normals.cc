// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/soft_normals.h"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace flocklift {
namespace {

Vec3d FaceNormal(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return Normalized(Cross(b - a, c - a));
}

double AngleAt(const Vec3d& p, const Vec3d& q, const Vec3d& r) {
  const Vec3d a = q - p, b = r - p;
  return std::atan2(Norm(Cross(a, b)), Dot(a, b));
}

}  // namespace

std::vector<Vec3d> SoftNormals(const TriangleMesh& mesh, double crease_deg) {
  const std::size_t count = mesh.triangles.size();
  std::vector<Vec3d> face(count);
  std::vector<std::uint32_t> first(mesh.vertices.size() + 1), corners(3 * count);
  for (std::size_t t = 0; t < count; ++t) {
    face[t] = FaceNormal(mesh.Corner(t, 0), mesh.Corner(t, 1), mesh.Corner(t, 2));
    for (const std::uint32_t vertex : mesh.triangles[t]) ++first[vertex + 1];
  }
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::size_t k = 0; k < 3 * count; ++k) {
    corners[next[mesh.triangles[k / 3][k % 3]]++] = static_cast<std::uint32_t>(k);
  }
  const double limit = std::cos(crease_deg * std::numbers::pi / 180);
  std::vector<Vec3d> normals(3 * count);
  for (std::size_t k = 0; k < 3 * count; ++k) {
    const std::uint32_t vertex = mesh.triangles[k / 3][k % 3];
    Vec3d sum;
    for (std::uint32_t at = first[vertex]; at < first[vertex + 1]; ++at) {
      const std::size_t t = corners[at] / 3, c = corners[at] % 3;
      if (Dot(face[t], face[k / 3]) < limit) continue;
      sum += AngleAt(mesh.Corner(t, c), mesh.Corner(t, (c + 1) % 3), mesh.Corner(t, (c + 2) % 3)) *
             face[t];
    }
    const Vec3d normal = Normalized(sum);
    normals[k] = normal == Vec3d{} ? face[k / 3] : normal;
  }
  return normals;
}

}  // namespace flocklift
