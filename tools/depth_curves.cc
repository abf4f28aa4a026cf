// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/depth_curves.h"

#include <fmt/format.h>

#include <algorithm>

#include "simulate/core/check.h"
#include "tools/plot/plot.h"

namespace flocklift {
namespace {

constexpr int kColumns = 3;
constexpr double kPanelWidth = 460, kPanelHeight = 300, kGap = 20;  // [px]
constexpr double kMostShown = 40;                                   // [%]

// What the panels' classes and colours (tools/plot/plot.h) look like outside the report.
constexpr std::string_view kStyle = R"css(
:root { --ink: #1b2330; --muted: #5d6877; --grid: #e8ebef; --line: #dfe3e8; --panel: #ffffff;
  --c0: #0072b2; --c1: #d55e00; --c2: #009e73; --c3: #b3589a; --c4: #c98a00; --c5: #3f9bd4; }
text { font: 12px sans-serif; fill: var(--ink); }
.title { font-size: 15px; font-weight: 600; }
.label, .tick { fill: var(--muted); }
.grid { stroke: var(--grid); fill: none; }
.axis { stroke: var(--muted); fill: none; }
)css";

Plot PanelPlot(const DepthPanel& panel) {
  double highest = 0;
  for (const DepthCurve& curve : panel.curves) {
    for (const double error : curve.absolute) highest = std::max(highest, 100 * error);
  }
  Plot plot({.title = panel.sweep.name,
             .x_label = panel.sweep.name,
             .y_label = "median depth error [%]",
             .width = kPanelWidth,
             .height = kPanelHeight,
             .y_low = 0,
             .y_high = std::min(kMostShown, 1.08 * highest)});
  for (std::size_t m = 0; m < panel.curves.size(); ++m) {
    const DepthCurve& curve = panel.curves[m];
    std::vector<Vec2d> absolute, scaled;
    for (std::size_t k = 0; k < panel.sweep.amounts.size(); ++k) {
      absolute.push_back({panel.sweep.amounts[k], 100 * curve.absolute[k]});
      scaled.push_back({panel.sweep.amounts[k], 100 * curve.scaled[k]});
    }
    PlotStyle style{.color = SeriesColor(m), .label = curve.method};
    plot.AddLine(absolute, style);
    style.label.clear();
    style.width = 5;
    plot.AddPoints(absolute, style);
    plot.AddLine(scaled, {.color = SeriesColor(m), .width = 1.2, .dash = "5 4"});
  }
  return plot;
}

void CheckPanel(const DepthPanel& panel) {
  for (const DepthCurve& curve : panel.curves) {
    Check(curve.absolute.size() == panel.sweep.amounts.size() &&
              curve.scaled.size() == panel.sweep.amounts.size(),
          "a curve needs an error for each amount");
  }
}

}  // namespace

const std::vector<DepthSweep>& DepthSweeps() {
  static const std::vector<DepthSweep> sweeps = {
      {"identity switches per 1000 rows",
       {0, 1, 2, 5, 10},
       [](double amount, DepthCase* c) { c->faults.switches = amount; }},
      {"missing detections [%]",
       {0, 5, 10, 20},
       [](double amount, DepthCase* c) { c->noise.miss = 0.01 * amount; }},
      {"position noise [px]",
       {0, 0.5, 1, 2},
       [](double amount, DepthCase* c) { c->noise.position_sd = amount; }},
      {"told speed off by [%]",
       {-20, -10, 0, 10, 20},
       [](double amount, DepthCase* c) { c->told_speed = 1 + 0.01 * amount; }},
      {"told focal length off by [%]", {-10, -5, 0, 5, 10}, [](double amount, DepthCase* c) {
         c->told_focal = 1 + 0.01 * amount;
       }}};
  return sweeps;
}

std::string DepthCurvesPicture(const std::vector<DepthPanel>& panels) {
  const int count = static_cast<int>(panels.size());
  const int rows = (count + kColumns - 1) / kColumns;
  const double width = kColumns * (kPanelWidth + kGap) + kGap;
  const double top = 54, row_height = kPanelHeight + kGap;
  const double height = top + rows * row_height;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\">\n<style>{2}</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
      "<text class=\"title\" x=\"{3:.0f}\" y=\"24\">Depth errors by what goes wrong</text>\n"
      "<text x=\"{3:.0f}\" y=\"43\">Solid: absolute. Dashed: after one global scale. "
      "Errors beyond {4:.0f} % are not drawn.</text>\n",
      width, height, kStyle, kGap, kMostShown);
  for (int k = 0; k < count; ++k) {
    const DepthPanel& panel = panels[static_cast<std::size_t>(k)];
    CheckPanel(panel);
    const int column = k % kColumns, row = k / kColumns;
    svg += fmt::format(
        "<svg x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\">\n{}</svg>\n",
        kGap + column * (kPanelWidth + kGap), top + row * row_height, kPanelWidth, kPanelHeight,
        PanelPlot(panel).Svg());
  }
  return svg + "</svg>\n";
}

std::string DepthCurvesTable(const std::vector<DepthPanel>& panels) {
  std::string text =
      "| trouble | amount | method | median error, % | after one scale, % |\n"
      "| --- | ---: | --- | ---: | ---: |\n";
  for (const DepthPanel& panel : panels) {
    CheckPanel(panel);
    for (std::size_t k = 0; k < panel.sweep.amounts.size(); ++k) {
      for (const DepthCurve& curve : panel.curves) {
        text += fmt::format("| {} | {} | {} | {:.2f} | {:.2f} |\n", panel.sweep.name,
                            panel.sweep.amounts[k], curve.method, 100 * curve.absolute[k],
                            100 * curve.scaled[k]);
      }
    }
  }
  return text;
}

}  // namespace flocklift
