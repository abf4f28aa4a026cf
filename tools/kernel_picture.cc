// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/kernel_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "tools/plot/plot.h"

namespace flocklift {
namespace {

constexpr double kWidth = 760, kHeight = 340, kMargin = 16, kTop = 52;  // [px]
constexpr double kDensityHeight = 0.15;  // of the panel, at its bottom
constexpr double kHeadroom = 0.08;       // beside what is known, of its range

constexpr std::string_view kStyle = R"css(
text { font: 12px sans-serif; fill: var(--ink); }
.title { font-size: 15px; font-weight: 600; }
.label, .tick { fill: var(--muted); }
.grid { stroke: var(--grid); fill: none; }
.axis { stroke: var(--muted); fill: none; }
)css";

// The plot's colours (tools/plot/plot.h) outside the report. Put in as they are: viewers of SVG
// other than browsers know no variables.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kColors = {
    {{"var(--ink)", "#1b2330"},
     {"var(--muted)", "#5d6877"},
     {"var(--grid)", "#e8ebef"},
     {"var(--c0)", "#0072b2"},
     {"var(--c1)", "#d55e00"}}};

std::string WithColors(std::string svg) {
  for (const auto& [name, color] : kColors) {
    for (std::size_t at = 0; (at = svg.find(name, at)) != std::string::npos; at += color.size()) {
      svg.replace(at, name.size(), color);
    }
  }
  return svg;
}

Plot KernelPlot(const FittedKernel& kernel, int order, const std::function<double(double)>& truth) {
  double low = 0, high = 0, densest = 0;
  for (const KernelPoint& point : kernel.points) {
    densest = std::max(densest, point.density);
    if (!point.known) continue;
    low = std::min(low, point.value - 1.96 * point.sd);
    high = std::max(high, point.value + 1.96 * point.sd);
  }
  if (!(high > low)) high = low + 1;
  const double room = kHeadroom * (high - low);
  low -= room + kDensityHeight * (high - low);
  high += room;
  Plot plot({.title = kernel.name,
             .x_label = "distance [m]",
             .y_label = kernel.Unit(order) == "1/s" ? "phi [1/s]" : "phi [1/s²]",
             .width = kWidth,
             .height = kHeight,
             .y_low = low,
             .y_high = high});
  std::vector<BandPoint> density, band;
  std::vector<Vec2d> known, unknown, is;
  for (const KernelPoint& point : kernel.points) {
    const double r = point.distance, half = 1.96 * point.sd;
    density.push_back(
        {r, low, low + kDensityHeight * (high - low) * point.density / std::max(densest, 1e-300)});
    band.push_back(
        {r, std::clamp(point.value - half, low, high), std::clamp(point.value + half, low, high)});
    const bool shown = point.value > low && point.value < high;
    known.push_back({r, point.known && shown ? point.value : std::nan("")});
    unknown.push_back({r, !point.known && shown ? point.value : std::nan("")});
    if (truth) is.push_back({r, truth(r)});
  }
  plot.AddBand(density, {.color = "var(--muted)", .opacity = 0.25, .label = "density of pairs"});
  plot.AddHorizontalLine(0, {.color = "var(--muted)", .width = 1, .sets_range = false});
  plot.AddBand(band, {.opacity = 0.25, .label = "95 %"});
  if (truth) plot.AddLine(is, {.color = "var(--c1)", .label = "true", .sets_range = false});
  plot.AddLine(known, {.label = "fitted"});
  plot.AddLine(unknown, {.width = 1.2, .dash = "5 4", .label = "not known"});
  return plot;
}

}  // namespace

std::string KernelsPicture(const std::vector<FittedKernel>& kernels, int order,
                           const std::vector<std::function<double(double)>>& truths) {
  const double height = kTop + static_cast<double>(kernels.size()) * (kHeight + kMargin);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\">\n<style>{2}</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
      "<text class=\"title\" x=\"{3:.0f}\" y=\"24\">Interaction kernels</text>\n"
      "<text x=\"{3:.0f}\" y=\"42\">phi &gt; 0 attracts or aligns. Bands: 95 % at each distance. "
      "Dashed: not known.</text>\n",
      kWidth + 2 * kMargin, height, kStyle, kMargin);
  for (std::size_t k = 0; k < kernels.size(); ++k) {
    const std::function<double(double)> truth = k < truths.size() ? truths[k] : nullptr;
    svg += fmt::format(
        "<svg x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\">\n{}</svg>\n", kMargin,
        kTop + static_cast<double>(k) * (kHeight + kMargin), kWidth, kHeight,
        KernelPlot(kernels[k], order, truth).Svg());
  }
  return WithColors(svg + "</svg>\n");
}

std::string KernelsTable(const std::vector<FittedKernel>& kernels, int order) {
  std::string text = "# units: distance m; density 1/m; value, sd, low, high";
  for (const FittedKernel& kernel : kernels) {
    text += fmt::format("{} {} of {}", &kernel == kernels.data() ? "" : ",", kernel.Unit(order),
                        kernel.name);
  }
  text += "\nkernel,distance,value,sd,low,high,density,known\n";
  for (const FittedKernel& kernel : kernels) {
    for (const KernelPoint& point : kernel.points) {
      text += fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{}\n", kernel.name,
                          point.distance, point.value, point.sd, point.value - 1.96 * point.sd,
                          point.value + 1.96 * point.sd, point.density, point.known ? 1 : 0);
    }
  }
  return text;
}

}  // namespace flocklift
