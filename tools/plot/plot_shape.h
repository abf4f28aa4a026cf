// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a plot shows: a line, a band, .., in the data's own units, and how it looks.

#ifndef FLOCKLIFT_TOOLS_PLOT_PLOT_SHAPE_H_
#define FLOCKLIFT_TOOLS_PLOT_PLOT_SHAPE_H_

#include <string>
#include <vector>

#include "simulate/core/vec3.h"

namespace flocklift {

struct PlotStyle {
  std::string color = "var(--c0)";
  double width = 1.8;  // of a line, or diameter of a point [px]
  double opacity = 1;
  std::string dash = {};   // SVG's stroke-dasharray
  std::string label = {};  // in the legend; none when empty
  bool sets_range = true;  // does it count when the axes look for their range?
};

struct PlotShape {
  enum class Kind { kLine, kBand, kPoints, kBars, kArrow, kText, kVertical, kHorizontal };
  Kind kind = Kind::kLine;
  PlotStyle style;
  std::vector<Vec2d> points = {};  // of a band: the lower edge; of bars: left end and height
  std::vector<Vec2d> upper = {};   // of a band
  double bar_width = 0;
  std::string text = {};
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_PLOT_PLOT_SHAPE_H_
