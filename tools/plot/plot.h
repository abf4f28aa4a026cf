// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A plot as inline SVG: axes with round numbers, lines, bands, points, bars, arrows, legend.
// Colours are CSS (`var(--c0)` .. `var(--c7)` for series, `var(--ink)`, `var(--muted)`,
// `var(--grid)` for the frame), so the page decides and dark mode works. Text is escaped. Long
// series are simplified to what the pixels can show.

#ifndef FLOCKLIFT_TOOLS_PLOT_PLOT_H_
#define FLOCKLIFT_TOOLS_PLOT_PLOT_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "simulate/core/vec3.h"
#include "tools/plot/histogram.h"
#include "tools/plot/plot_shape.h"

namespace flocklift {

// The page's colour of series k, repeating after 8.
std::string SeriesColor(std::size_t k);

struct PlotOptions {
  std::string title = {};
  std::string x_label = {};  // with unit
  std::string y_label = {};
  double width = 1040;      // of the whole picture [px]
  double height = 300;      // 0 with equal axes: what the data need
  bool equal_axes = false;  // one metre is as long in x as in y
  bool nice_x = false;      // let the x axis end at round numbers
  std::optional<double> x_low = {}, x_high = {}, y_low = {}, y_high = {};  // else from the data
};

// The part of a band at one x. A NaN interrupts.
struct BandPoint {
  double x = 0, low = 0, high = 0;
};

class Plot {
 public:
  explicit Plot(PlotOptions options) : options_(std::move(options)) {}

  // A NaN interrupts the line.
  void AddLine(std::vector<Vec2d> points, PlotStyle style);
  void AddBand(std::vector<BandPoint> points, PlotStyle style);
  void AddPoints(std::vector<Vec2d> points, PlotStyle style);
  void AddBars(const Histogram& histogram, PlotStyle style);
  // The outline of a histogram, to lay over another.
  void AddOutline(const Histogram& histogram, PlotStyle style);
  // An arrow head of `style.width` px at `at`, pointing along `direction` of the data's axes.
  void AddArrow(const Vec2d& at, const Vec2d& direction, PlotStyle style);
  // Words beside a point.
  void AddText(const Vec2d& at, std::string text, PlotStyle style);
  void AddVerticalLine(double x, PlotStyle style);
  void AddHorizontalLine(double y, PlotStyle style);

  std::string Svg() const;

 private:
  PlotOptions options_;
  std::vector<PlotShape> shapes_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_PLOT_PLOT_H_
