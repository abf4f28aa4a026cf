// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Does a straight line keep clear of the obstacles? Where it does, and a metre costs the same all
// along it, no way is cheaper, and the cost of it needs no front that marches there. Seen by sphere
// tracing: from each place on, as far as the distance to the obstacles allows. J. C. Hart, "Sphere
// tracing: a geometric method for the antialiased ray tracing of implicit surfaces", The Visual
// Computer 12 (1996) 527-545.

#ifndef FLOCKLIFT_SIMULATE_FIELDS_CLEAR_LINE_H_
#define FLOCKLIFT_SIMULATE_FIELDS_CLEAR_LINE_H_

#include "simulate/fields/grid_field.h"

namespace flocklift {

// Whether all of the line from `from` to `to` is at least `clearance` away [m]; `distance` to the
// obstacles [m], trilinear between its nodes. What comes that near for less than half a spacing can
// be overlooked.
bool IsClearLine(const ScalarField& distance, const Vec3d& from, const Vec3d& to, double clearance);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FIELDS_CLEAR_LINE_H_
