// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The parts of a plot's SVG: strokes, fills, paths and words.

#ifndef FLOCKLIFT_TOOLS_PLOT_SVG_PARTS_H_
#define FLOCKLIFT_TOOLS_PLOT_SVG_PARTS_H_

#include <string>
#include <string_view>
#include <vector>

#include "simulate/core/vec3.h"
#include "tools/plot/plot_shape.h"

namespace flocklift {

// Attributes of a line and of an area.
std::string Stroke(const PlotStyle& style);
std::string Fill(const PlotStyle& style);

// "M x y l dx dy ..": relative moves, tenths of a pixel.
std::string PathOf(const std::vector<Vec2d>& points);

// About, in the page's font [px].
double TextWidth(std::string_view text);

// Words at a place, escaped; `anchor` is SVG's text-anchor or empty, `kind` the class.
std::string PixelText(double x, double y, std::string_view anchor, std::string_view kind,
                      std::string_view text);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_PLOT_SVG_PARTS_H_
