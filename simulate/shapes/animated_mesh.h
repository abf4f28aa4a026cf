// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A surface that moves: key-frames of one topology, evenly spaced in time. What is stored as
// (triangle, barycentric) moves with it.

#ifndef FLOCKLIFT_SIMULATE_SHAPES_ANIMATED_MESH_H_
#define FLOCKLIFT_SIMULATE_SHAPES_ANIMATED_MESH_H_

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulate/core/triangle_mesh.h"

namespace flocklift {

struct AnimatedMesh {
  std::vector<std::array<std::uint32_t, 3>> triangles;  // T x 3, indices of vertices
  std::vector<std::vector<Vec3d>> key_frames;           // K x V, K >= 1 [m]

  TriangleMesh Frame(std::size_t k) const { return {key_frames[k], triangles}; }
};

// The vertices at `phase`, counted in key-frames: 1.5 is half-way between the second and the third.
// Past the last one the animation starts again, the last key-frame passing over into the first.
inline std::vector<Vec3d> VerticesAt(const AnimatedMesh& mesh, double phase) {
  const auto count = static_cast<double>(mesh.key_frames.size());
  const double turned = phase - count * std::floor(phase / count);
  const std::size_t k = static_cast<std::size_t>(turned) % mesh.key_frames.size();
  const double share = turned - std::floor(turned);
  const std::vector<Vec3d>& from = mesh.key_frames[k];
  const std::vector<Vec3d>& to = mesh.key_frames[(k + 1) % mesh.key_frames.size()];
  std::vector<Vec3d> vertices(from.size());
  for (std::size_t v = 0; v < from.size(); ++v) {
    vertices[v] = (1 - share) * from[v] + share * to[v];
  }
  return vertices;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_ANIMATED_MESH_H_
