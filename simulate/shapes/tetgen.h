// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// TetGen (H. Si, ACM TOMS 2015), when the build has it: CMake option FLOCKLIFT_WITH_TETGEN. TetGen
// is under the AGPL, and so is a program that is built with it.

#ifndef FLOCKLIFT_SIMULATE_SHAPES_TETGEN_H_
#define FLOCKLIFT_SIMULATE_SHAPES_TETGEN_H_

#include "simulate/shapes/tetrahedralize.h"

namespace flocklift {

// Bounds the radius-edge ratio; the number of tetrahedra follows from the surface's triangles, and
// from the cell when there is one (as a bound on the volume). Throws std::invalid_argument when the
// build has no TetGen or the surface intersects itself.
TetraMesh TetrahedralizeByTetgen(const TriangleMesh& surface, const TetrahedralizeOptions& options);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_TETGEN_H_
