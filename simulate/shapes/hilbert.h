// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The Hilbert curve through a cube of 2^21 cells a side: points near each other on the curve are
// near each other in space.

#ifndef FLOCKLIFT_SIMULATE_SHAPES_HILBERT_H_
#define FLOCKLIFT_SIMULATE_SHAPES_HILBERT_H_

#include <cstdint>
#include <vector>

#include "simulate/core/vec3.h"

namespace flocklift::internal {

// Place on the curve of a cell, each index below 2^21 (Skilling 2004, AIP Conf. Proc. 707, 381).
std::uint64_t HilbertIndex(std::uint32_t x, std::uint32_t y, std::uint32_t z);

// Indices of the points in the order of the curve through their bounding cube.
std::vector<std::uint32_t> HilbertOrder(const std::vector<Vec3d>& points);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_SHAPES_HILBERT_H_
