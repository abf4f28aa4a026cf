// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The creases of a surface: edges where it bends by more than an angle, the corners where creases
// end, meet or turn, and the smooth patches of triangles between them.

#ifndef FLOCKLIFT_SIMULATE_SHAPES_FEATURE_LINES_H_
#define FLOCKLIFT_SIMULATE_SHAPES_FEATURE_LINES_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "simulate/core/triangle_mesh.h"

namespace flocklift {

struct FeatureLines {
  struct Segment {
    Vec3d from, to;
    std::array<std::uint32_t, 2> patches;  // on both sides, the smaller first; may be equal
  };
  struct Corner {
    Vec3d point;
    std::vector<std::uint32_t> patches;  // that touch it, ascending
  };
  std::vector<std::uint32_t> patch_of_triangle;
  std::vector<Segment> segments;
  std::vector<Corner> corners;
};

// Vertices at the same place count as one. `crease_angle` [rad] is between the normals.
FeatureLines FindFeatureLines(const TriangleMesh& surface, double crease_angle);

Vec3d NearestOnSegment(const Vec3d& p, const Vec3d& from, const Vec3d& to);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_FEATURE_LINES_H_
