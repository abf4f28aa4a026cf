// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The SVG of a plot's shapes.

#ifndef FLOCKLIFT_TOOLS_PLOT_DRAW_SHAPE_H_
#define FLOCKLIFT_TOOLS_PLOT_DRAW_SHAPE_H_

#include <string>

#include "tools/plot/plot_frame.h"
#include "tools/plot/plot_shape.h"

namespace flocklift {

// Appends a shape; (0, 0) is the top-left corner of the frame's area.
void AppendShape(const PlotFrame& frame, const PlotShape& shape, std::string* svg);

// Appends a sample for the legend, 18 px wide, whose left end is at (u, v) [px].
void AppendSample(const PlotShape& shape, double u, double v, std::string* svg);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_PLOT_DRAW_SHAPE_H_
