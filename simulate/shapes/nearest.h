// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Nearest neighbours where points have no natural cell size (FLANN's kd-tree, exact).

#ifndef FLOCKLIFT_SIMULATE_SHAPES_NEAREST_H_
#define FLOCKLIFT_SIMULATE_SHAPES_NEAREST_H_

#include <cstdint>
#include <vector>

#include "simulate/core/parallel_for.h"
#include "simulate/core/vec3.h"

namespace flocklift::internal {

// For each point its `count` nearest others by the Euclidean distance, the nearest first; all
// when there are no more than `count`.
std::vector<std::vector<std::uint32_t>> NearestOthers(const std::vector<Vec3d>& points, int count,
                                                      ThreadPool* pool);

// For each point the others nearer than `radius` by the Manhattan distance, in no special order
// (but always the same).
std::vector<std::vector<std::uint32_t>> ManhattanNeighbours(const std::vector<Vec3d>& points,
                                                            double radius, ThreadPool* pool);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_SHAPES_NEAREST_H_
