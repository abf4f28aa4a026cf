// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Walking straight on over a surface: what lies beyond an edge is unfolded into the plane of the
// triangle before it.

#ifndef FLOCKLIFT_SIMULATE_SHAPES_SURFACE_WALK_H_
#define FLOCKLIFT_SIMULATE_SHAPES_SURFACE_WALK_H_

#include <array>
#include <cstdint>
#include <vector>

#include "simulate/core/triangle_mesh.h"
#include "simulate/shapes/surface_samples.h"

namespace flocklift::internal {

class SurfaceWalk {
 public:
  // `mesh` must outlive this.
  explicit SurfaceWalk(const TriangleMesh& mesh);

  // Unit normal of a triangle; 0 when it has no area.
  const Vec3d& Normal(std::uint32_t triangle) const { return normal_[triangle]; }

  // From `start` along `way` [m], of which what points out of the start's triangle is dropped.
  // Stops where the surface ends (a boundary, or a triangle without area).
  SurfaceSample Go(const SurfaceSample& start, const Vec3d& way) const;

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  const TriangleMesh& mesh_;
  std::vector<Vec3d> normal_;
  std::vector<std::array<std::uint32_t, 3>> across_;  // the triangle beyond the edge opposite to k
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_SHAPES_SURFACE_WALK_H_
