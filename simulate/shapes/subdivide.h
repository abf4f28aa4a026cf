// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// More tetrahedra out of few, exactly as many as wanted (equations.md, section 7): with n1 to start
// from, all are cut 1 -> 4 k times, k = floor(log4(n / n1)); then m = 4^k n1, d = floor((n - m) /
// 3), r = n - m - 3 d: the d largest by volume are cut 1 -> 4, and the next one 1 -> 1 + r.
//   1 -> 4  the centroid to the four faces
//   1 -> 3  the centroid of the largest face to the opposite corner
//   1 -> 2  the middle of the longest edge to the opposite edge
// The pieces of one tetrahedron are equally large and together are it; they no longer share whole
// faces with neighbours, hence tetrahedra one by one.

#ifndef FLOCKLIFT_SIMULATE_SHAPES_SUBDIVIDE_H_
#define FLOCKLIFT_SIMULATE_SHAPES_SUBDIVIDE_H_

#include <array>
#include <cstddef>
#include <vector>

#include "simulate/shapes/tetra_mesh.h"

namespace flocklift {

std::array<Tetra, 4> CutInFour(const Tetra& t);
std::array<Tetra, 3> CutInThree(const Tetra& t);
std::array<Tetra, 2> CutInTwo(const Tetra& t);

// Exactly `count` tetrahedra. Throws std::invalid_argument when there are more already, or none.
std::vector<Tetra> SubdivideTo(std::size_t count, std::vector<Tetra> tetrahedra);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_SHAPES_SUBDIVIDE_H_
