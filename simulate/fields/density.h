// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How many animals there are per cubic metre (per square metre of a flat grid), on the nodes of a
// grid: every animal is shared out to the corners of its cell by the trilinear weights, so that the
// sum over nodes times a cell's volume is the number of animals. Sums are in the animals' order.

#ifndef FLOCKLIFT_SIMULATE_FIELDS_DENSITY_H_
#define FLOCKLIFT_SIMULATE_FIELDS_DENSITY_H_

#include <span>

#include "simulate/fields/grid_field.h"

namespace flocklift {

// Animals beyond the grid count at its rim.
ScalarField DensityField(const Grid& grid, std::span<const Vec3d> positions);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FIELDS_DENSITY_H_
