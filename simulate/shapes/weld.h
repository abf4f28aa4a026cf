// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Corners that stand at the same place become one vertex.

#ifndef FLOCKLIFT_SIMULATE_SHAPES_WELD_H_
#define FLOCKLIFT_SIMULATE_SHAPES_WELD_H_

#include <array>
#include <cstdint>
#include <vector>

#include "simulate/core/vec3.h"
#include "simulate/shapes/animated_mesh.h"

namespace flocklift::internal {

// A mesh before welding: vertices may repeat.
struct Soup {
  std::vector<Vec3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

// `frames` share their triangles. Vertices are welded where they agree, exactly, in all frames;
// the first of them keeps its place in the order. Triangles with two corners in one vertex go.
AnimatedMesh Weld(const std::vector<Soup>& frames);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_SHAPES_WELD_H_
