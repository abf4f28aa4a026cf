// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A scalar on the nodes of a regular grid, and what lies between the nodes:
//   SampleLinear  the trilinear interpolant and its gradient, which jumps from cell to cell
//   SampleSmooth  the quadratic B-spline over 27 nodes: value and gradient are continuous, second
//                 derivatives are exact ones of that gradient. It reproduces linear functions (a
//                 node away from the rim); a curved one it smooths (value + f'' l^2 / 8).
// Beyond the outer nodes a field continues with the value of the nearest point of the grid.

#ifndef FLOCKLIFT_SIMULATE_FIELDS_GRID_FIELD_H_
#define FLOCKLIFT_SIMULATE_FIELDS_GRID_FIELD_H_

#include <cstddef>
#include <vector>

#include "simulate/core/vec3.h"

namespace flocklift {

// A node by its number along each axis.
struct GridPlace {
  int i = 0, j = 0, k = 0;
};

// Where the nodes are. One node along an axis makes a flat field.
struct Grid {
  Vec3d low;                   // of node (0, 0, 0) [m]
  double spacing = 1;          // l, between nodes, the same along all axes [m]
  int nx = 1, ny = 1, nz = 1;  // nodes

  std::size_t size() const { return static_cast<std::size_t>(nx) * ny * nz; }
  // x fastest, then y, z.
  std::size_t Index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * ny + j) * nx + i;
  }
  Vec3d Node(int i, int j, int k) const {
    return low + Vec3d{i * spacing, j * spacing, k * spacing};
  }
  GridPlace Place(std::size_t index) const {
    const std::size_t row = index / nx;
    return {static_cast<int>(index % nx), static_cast<int>(row % ny), static_cast<int>(row / ny)};
  }
  Vec3d Node(std::size_t index) const {
    const GridPlace at = Place(index);
    return Node(at.i, at.j, at.k);
  }
  Vec3d High() const { return Node(nx - 1, ny - 1, nz - 1); }
  // Index of the node nearest to a point (to its nearest point of the grid).
  std::size_t Nearest(const Vec3d& p) const;

  // Calls fn(side, neighbour) for those of the six neighbours that there are; sides 0 .. 5 are
  // before and after along x, then y, z.
  template <typename Function>
  void ForEachNeighbour(std::size_t node, const Function& fn) const {
    const GridPlace at = Place(node);
    const std::size_t row = nx, slice = row * ny;
    if (at.i > 0) fn(0, node - 1);
    if (at.i + 1 < nx) fn(1, node + 1);
    if (at.j > 0) fn(2, node - row);
    if (at.j + 1 < ny) fn(3, node + row);
    if (at.k > 0) fn(4, node - slice);
    if (at.k + 1 < nz) fn(5, node + slice);
  }

  friend bool operator==(const Grid&, const Grid&) = default;
};

// The grid of that spacing [m] that starts at `low` and covers the box up to `high`. Throws
// std::invalid_argument for a box that is empty or would need more than 2^31 nodes.
Grid GridOver(const Vec3d& low, const Vec3d& high, double spacing);

// The cell of a point: its lower node, the way through it (0 .. 1 along each axis), and how far on
// the next node along each axis is stored (0 where there is but one node).
struct GridCell {
  std::size_t index;
  std::size_t step_x, step_y, step_z;
  Vec3d u;

  // Calls fn(node, weight) for the eight corners with their trilinear weights, in a fixed order.
  template <typename Function>
  void ForEachCorner(const Function& fn) const {
    for (int corner = 0; corner < 8; ++corner) {
      const bool x = corner & 1, y = corner & 2, z = corner & 4;
      fn(index + (x ? step_x : 0) + (y ? step_y : 0) + (z ? step_z : 0),
         (x ? u.x : 1 - u.x) * (y ? u.y : 1 - u.y) * (z ? u.z : 1 - u.z));
    }
  }
};
GridCell CellOf(const Grid& grid, const Vec3d& p);

struct FieldSample {
  double value = 0;
  Vec3d gradient;  // [1/m] of the unit of the value
};
struct SmoothSample {
  double value = 0;
  Vec3d gradient;                 // [1/m]
  double xx = 0, yy = 0, zz = 0;  // second derivatives [1/m^2]
  double xy = 0, xz = 0, yz = 0;
};

struct ScalarField {
  Grid grid;
  std::vector<float> values;  // by Grid::Index

  double Sample(const Vec3d& p) const;
  FieldSample SampleLinear(const Vec3d& p) const;
  SmoothSample SampleSmooth(const Vec3d& p) const;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FIELDS_GRID_FIELD_H_
