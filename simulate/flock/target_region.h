// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where tetrahedra leave the path and make for their places (equations.md, section 7, phase 2).
//   sphere  the minimal bounding sphere of the target: as published. A long, thin target's sphere
//   is
//           mostly empty, and the flock fans out long before it is there.
//   box     the box about the target's principal axes
//   shape   all within a margin of the target itself, whatever its form: the default
// Box and shape include the margin; all have a bounding sphere, which is tested first.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_TARGET_REGION_H_
#define FLOCKLIFT_SIMULATE_FLOCK_TARGET_REGION_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "simulate/core/vec3.h"
#include "simulate/flock/kernels/morph_kernel.h"
#include "simulate/shapes/tetra_mesh.h"

namespace flocklift {

enum class RegionKind { kSphere, kBox, kShape };

struct BoundingSphere {
  Vec3d centre;
  double radius = 0;  // [m]
};

// The smallest one (E. Welzl, "Smallest enclosing disks", 1991, by moving to the front), exact to
// round-off. The order of the points does not matter for the result.
BoundingSphere SmallestSphere(std::span<const Vec3d> points);

class TargetRegion {
 public:
  TargetRegion() = default;
  // `margin` > 0 for a shape [m].
  TargetRegion(RegionKind kind, std::span<const Tetra> target, double margin);

  bool Contains(const Vec3d& p) const;
  // What the kernel needs to know of it: whoever is in the region is in this too.
  MorphRegion View() const;
  const BoundingSphere& sphere() const { return sphere_; }

 private:
  void FitBox(std::span<const Vec3d> corners, double margin);
  void FillCells(std::span<const Tetra> target, double margin);

  RegionKind kind_ = RegionKind::kSphere;
  BoundingSphere sphere_;
  std::array<Vec3d, 3> axes_;       // of the box, unit
  Vec3d low_, high_;                // along the axes; of the grid of cells
  MorphRegion cells_{};             // of the shape
  std::vector<std::uint8_t> bits_;  // likewise
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_TARGET_REGION_H_
