// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// From a closed, oriented surface to a solid of tetrahedra. Our own way is a lattice fitted to the
// surface (simulate/shapes/lattice_fill.h, creases.h). Built with FLOCKLIFT_WITH_TETGEN (AGPL),
// Delaunay refinement by TetGen is there besides, with radius-edge ratios up to 2.

#ifndef FLOCKLIFT_SIMULATE_SHAPES_TETRAHEDRALIZE_H_
#define FLOCKLIFT_SIMULATE_SHAPES_TETRAHEDRALIZE_H_

#include "simulate/core/triangle_mesh.h"
#include "simulate/shapes/tetra_mesh.h"

namespace flocklift {

struct TetrahedralizeOptions {
  double cell = 0;             // edge of the lattice's cubes [m]; 0: by most_tetrahedra
  int most_tetrahedra = 5000;  // the finest lattice that stays within (a few per cent below)
  bool tetgen = false;         // needs a build with it
  double radius_edge = 2.0;    // TetGen's bound
};

// Whether this build has TetGen.
bool HasTetgen();

// All tetrahedra are positively oriented, inner faces belong to exactly two. Throws
// std::invalid_argument for a surface that encloses nothing, and for tetgen without it.
TetraMesh Tetrahedralize(const TriangleMesh& surface, const TetrahedralizeOptions& options);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_TETRAHEDRALIZE_H_
