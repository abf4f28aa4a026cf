// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The body-centred cubic lattice about a closed surface, which isosurface stuffing fills
// (simulate/shapes/lattice_fill.h), and which of its points are inside: those around which the
// winding number is positive, counted along the lattice's lines in z.

#ifndef FLOCKLIFT_SIMULATE_SHAPES_BODY_CENTRED_LATTICE_H_
#define FLOCKLIFT_SIMULATE_SHAPES_BODY_CENTRED_LATTICE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulate/core/triangle_mesh.h"
#include "simulate/core/vec3.h"

namespace flocklift {

// Points of the lattice: the corners of a grid of cubes, then their centres.
class BodyCentredLattice {
 public:
  // Throws std::invalid_argument where the cells would be too many for the surface.
  BodyCentredLattice(const TriangleMesh& surface, double cell);

  std::size_t size() const { return points_; }
  int cells(int axis) const { return n_[static_cast<std::size_t>(axis)]; }
  double cell() const { return cell_; }
  // The line (i, j) of corners (kind 0) or centres (kind 1) along z: its place and its points.
  Vec3d LineStart(int kind, int i, int j) const {
    return low_ + cell_ * (Vec3d{double(i), double(j), 0} + 0.5 * kind * Vec3d{1, 1, 1});
  }
  std::uint32_t Corner(int i, int j, int k) const {
    return static_cast<std::uint32_t>(
        (static_cast<std::size_t>(k) * (n_[1] + 1) + j) * (n_[0] + 1) + i);
  }
  std::uint32_t Centre(int i, int j, int k) const {
    return static_cast<std::uint32_t>(corners_ + (static_cast<std::size_t>(k) * n_[1] + j) * n_[0] +
                                      i);
  }
  std::uint32_t Point(int kind, int i, int j, int k) const {
    return kind == 0 ? Corner(i, j, k) : Centre(i, j, k);
  }
  bool IsLong(std::uint32_t a, std::uint32_t b) const {  // edges of corner and centre are short
    return (a < corners_) == (b < corners_);
  }

 private:
  Vec3d low_;
  double cell_;
  std::array<int, 3> n_;
  std::size_t corners_, points_;
};

// +1 inside, -1 outside, of every point.
std::vector<signed char> SignsOn(const BodyCentredLattice& lattice, const TriangleMesh& surface);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_BODY_CENTRED_LATTICE_H_
