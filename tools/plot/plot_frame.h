// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where data land in a plot's picture, and its axes.

#ifndef FLOCKLIFT_TOOLS_PLOT_PLOT_FRAME_H_
#define FLOCKLIFT_TOOLS_PLOT_PLOT_FRAME_H_

#include <span>
#include <string>
#include <vector>

#include "simulate/core/vec3.h"
#include "tools/plot/plot.h"
#include "tools/plot/ticks.h"

namespace flocklift {

struct PlotFrame {
  double left = 0, top = 0, width = 0, height = 0;  // of the area inside the axes [px]
  double picture_height = 0;
  AxisRange x, y;

  // Data to pixels from the area's top-left corner.
  Vec2d Local(const Vec2d& p) const {
    return {(p.x - x.low) / (x.high - x.low) * width, (y.high - p.y) / (y.high - y.low) * height};
  }
  std::vector<Vec2d> Local(const std::vector<Vec2d>& points) const {
    std::vector<Vec2d> local;
    local.reserve(points.size());
    for (const Vec2d& p : points) local.push_back(Local(p));
    return local;
  }
};

// Ranges from the options or, where these are silent, from the shapes.
PlotFrame MakeFrame(const PlotOptions& options, std::span<const PlotShape> shapes);

// The height of the line that holds the y label and the legend [px].
double HeaderLine(const PlotOptions& options);

// Appends grid, axes with their numbers, title and labels.
void AppendAxes(const PlotOptions& options, const PlotFrame& frame, std::string* svg);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_PLOT_PLOT_FRAME_H_
