// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The signed distance to obstacles on the nodes of a grid, positive outside [m]: exact at every
// node (as float), not only near the surfaces. Neighbouring nodes have nearly the same nearest
// triangle, so a walk through the grid that remembers it costs little more than a narrow band.

#ifndef FLOCKLIFT_SIMULATE_FIELDS_DISTANCE_FIELD_H_
#define FLOCKLIFT_SIMULATE_FIELDS_DISTANCE_FIELD_H_

#include <span>

#include "simulate/fields/grid_field.h"
#include "simulate/fields/solids.h"

namespace flocklift {

// What a field without any obstacle holds [m]: far enough for every use, small enough that
// interpolation stays finite.
inline constexpr float kNoObstacle = 1e9F;

// The union of `solids` on `grid`. The same bytes at any number of threads (0: all there are).
ScalarField DistanceField(const Grid& grid, std::span<const Solid> solids, int threads = 1);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FIELDS_DISTANCE_FIELD_H_
