// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/solid_meshes.h"

#include <algorithm>
#include <map>
#include <utility>

namespace flocklift {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

// Every triangle becomes four; the new vertices are the middles of the sides, on the unit sphere.
void CutInFour(TriangleMesh* mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [entry, is_new] =
        middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh->vertices.size()));
    if (is_new) mesh->vertices.push_back(Normalized(mesh->vertices[a] + mesh->vertices[b]));
    return entry->second;
  };
  std::vector<Triangle> finer;
  for (const auto& [a, b, c] : mesh->triangles) {
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  mesh->triangles = std::move(finer);
}

}  // namespace

TriangleMesh BoxMesh(const Vec3d& low, const Vec3d& high) {
  TriangleMesh mesh;
  for (unsigned k = 0; k < 8; ++k) {
    mesh.vertices.push_back({(k & 1U) != 0 ? high.x : low.x, (k & 2U) != 0 ? high.y : low.y,
                             (k & 4U) != 0 ? high.z : low.z});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TriangleMesh BallMesh(const Vec3d& centre, double radius, int rounds) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int round = 0; round < rounds; ++round) CutInFour(&mesh);
  for (Vec3d& vertex : mesh.vertices) vertex = centre + radius * vertex;
  return mesh;
}

}  // namespace flocklift
