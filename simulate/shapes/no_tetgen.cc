// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <stdexcept>

#include "simulate/shapes/tetgen.h"

namespace flocklift {

bool HasTetgen() { return false; }

TetraMesh TetrahedralizeByTetgen(const TriangleMesh&, const TetrahedralizeOptions&) {
  throw std::invalid_argument("this build has no TetGen (cmake -DFLOCKLIFT_WITH_TETGEN=ON)");
}

}  // namespace flocklift
