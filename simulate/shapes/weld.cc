// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/weld.h"

#include <cstddef>
#include <map>
#include <tuple>

namespace flocklift::internal {

AnimatedMesh Weld(const std::vector<Soup>& frames) {
  const std::size_t count = frames.front().vertices.size();
  // Classes of vertices, refined frame by frame; numbered in the order of their first member.
  std::vector<std::uint32_t> class_of(count, 0);
  std::uint32_t classes = 0;
  for (const Soup& frame : frames) {
    std::map<std::tuple<std::uint32_t, double, double, double>, std::uint32_t> seen;
    classes = 0;
    for (std::size_t v = 0; v < count; ++v) {
      const Vec3d p = frame.vertices[v] + Vec3d{};  // -0 becomes 0
      const auto [entry, is_new] = seen.emplace(std::tuple(class_of[v], p.x, p.y, p.z), classes);
      if (is_new) ++classes;
      class_of[v] = entry->second;
    }
  }
  AnimatedMesh mesh;
  for (const Soup& frame : frames) {
    std::vector<Vec3d>& vertices = mesh.key_frames.emplace_back(classes);
    for (std::size_t v = count; v-- > 0;) vertices[class_of[v]] = frame.vertices[v];
  }
  for (const auto& [a, b, c] : frames.front().triangles) {
    const std::uint32_t p = class_of[a], q = class_of[b], r = class_of[c];
    if (p != q && q != r && r != p) mesh.triangles.push_back({p, q, r});
  }
  return mesh;
}

}  // namespace flocklift::internal
