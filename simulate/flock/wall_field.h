// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The distance to the walls of a scene, positive inside [m]: the obstacles, and the scene's box
// seen from within. The grid reaches one cell beyond the box, so that who was pushed out finds the
// way back.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_WALL_FIELD_H_
#define FLOCKLIFT_SIMULATE_FLOCK_WALL_FIELD_H_

#include <optional>

#include "simulate/fields/grid_field.h"
#include "simulate/flock/world.h"

namespace flocklift {

// `spacing` of the grid [m]. With a `ground` there is one layer of nodes, at that height [m], and
// neither floor nor ceiling. Throws std::invalid_argument when the world has no box.
ScalarField WallField(const World& world, double spacing, int threads,
                      std::optional<double> ground = {});

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_WALL_FIELD_H_
