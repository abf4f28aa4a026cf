// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A surface of triangles, as it passes between rooms: shapes reads and samples it, fields measures
// distances to it, render draws it.

#ifndef FLOCKLIFT_SIMULATE_CORE_TRIANGLE_MESH_H_
#define FLOCKLIFT_SIMULATE_CORE_TRIANGLE_MESH_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulate/core/vec3.h"

namespace flocklift {

// Corners of a triangle run counter-clockwise seen from outside, so that
// (b - a) x (c - a) points outwards.
struct TriangleMesh {
  std::vector<Vec3d> vertices;                          // V x 3 [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;  // T x 3, indices of vertices

  const Vec3d& Corner(std::size_t triangle, std::size_t corner) const {
    return vertices[triangles[triangle][corner]];
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_TRIANGLE_MESH_H_
