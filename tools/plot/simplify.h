// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fewer points that look the same, so that a plot of a long sequence stays small.

#ifndef FLOCKLIFT_TOOLS_PLOT_SIMPLIFY_H_
#define FLOCKLIFT_TOOLS_PLOT_SIMPLIFY_H_

#include <cstddef>
#include <vector>

#include "simulate/core/vec3.h"

namespace flocklift {

// A polyline within `tolerance` of the given one (Douglas, Peucker 1973), ends kept; when that
// leaves more than `most` points, the lowest and the highest of equal pieces are kept, so that no
// spike is lost.
std::vector<Vec2d> SimplifyLine(const std::vector<Vec2d>& points, double tolerance,
                                std::size_t most);

// At most `most` of the points, evenly spread over the list.
std::vector<Vec2d> ThinOut(const std::vector<Vec2d>& points, std::size_t most);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_PLOT_SIMPLIFY_H_
