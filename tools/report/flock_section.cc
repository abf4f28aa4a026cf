// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "reconstruct/metrics/order_statistics.h"
#include "tools/plot/histogram.h"
#include "tools/plot/markup.h"
#include "tools/plot/plot.h"
#include "tools/plot/ticks.h"
#include "tools/report/sections.h"

namespace flocklift {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostValues = 200000;  // of a distribution
const PlotStyle kTruth{.color = "var(--ink)", .width = 1.4, .dash = "5 3", .label = "truth"};

std::vector<double> Speeds(const Trajectories& trajectories) {
  std::size_t rows = 0;
  for (const Trajectory& trajectory : trajectories.trajectories) rows += trajectory.points.size();
  const std::size_t stride = 1 + rows / kMostValues;
  std::vector<double> speeds;
  std::size_t row = 0;
  for (const Trajectory& trajectory : trajectories.trajectories) {
    for (const TrajectoryPoint& point : trajectory.points) {
      if (row++ % stride == 0) speeds.push_back(Norm(point.velocity));
    }
  }
  return speeds;
}

std::string SpeedHistogram(const ReportData& data) {
  std::vector<double> speeds = Speeds(*data.run.trajectories), true_speeds;
  if (data.run.true_trajectories && data.run.true_trajectories->has_velocity) {
    true_speeds = Speeds(*data.run.true_trajectories);
  }
  // The tail beyond the 99.5th percentile would only stretch the axis.
  const double high = std::max(*Quantile(speeds, 0.995), Quantile(true_speeds, 0.995).value_or(0));
  const AxisRange range = NiceRange(0, std::max(high, 1e-6), 10);
  Plot plot({.title = "Speeds",
             .x_label = "speed [m/s]",
             .y_label = "share of points [%]",
             .width = 520,
             .height = 270,
             .x_low = range.low,
             .x_high = range.high});
  plot.AddBars(MakeHistogram(speeds, range.low, range.high, 40),
               {.opacity = 0.75, .label = "reconstruction"});
  if (!true_speeds.empty()) {
    plot.AddOutline(MakeHistogram(true_speeds, range.low, range.high, 40), kTruth);
  }
  return plot.Svg();
}

std::string StepsText(const RunFolder& run) {
  const StepStatistics steps = ComputeSteps(*run.trajectories, *run.fps);
  std::string text = fmt::format(
      "From one frame to the next the animals move as fast as {} m/s in the median; 99 % of the "
      "steps are below {} m/s, the largest is {} m/s. ",
      NumberText(steps.median), NumberText(steps.p99), NumberText(steps.largest));
  if (steps.jumps == 0) return text + "No path jumps.";
  return text + fmt::format(
                    "{} of {} steps are more than {} times the median: there a path jumps, "
                    "as it does where a track was cut or an identity was confused.",
                    steps.jumps, steps.steps, NumberText(StepStatistics::kJump));
}

// One figure of the flock over time: median and 80 % band, and the truth's median.
template <typename Low, typename Middle, typename High>
std::string OverTime(const ReportData& data, PlotOptions options, std::size_t color, Low low,
                     Middle middle, High high) {
  options.x_label = data.run.TimeLabel();
  options.width = 520;
  options.height = 270;
  Plot plot(std::move(options));
  std::vector<BandPoint> band;
  std::vector<Vec2d> line, true_line;
  for (const FlockStatistics& moment : data.flock) {
    const double time = data.run.TimeOf(moment.frame);
    band.push_back({time, low(moment), high(moment)});
    line.push_back({time, middle(moment)});
  }
  for (const FlockStatistics& moment : data.true_flock) {
    true_line.push_back({data.run.TimeOf(moment.frame), middle(moment)});
  }
  const bool has_band =
      std::any_of(band.begin(), band.end(), [](const BandPoint& p) { return p.high > p.low; });
  if (has_band) {
    plot.AddBand(std::move(band),
                 {.color = SeriesColor(color), .opacity = 0.2, .label = "80 % of the animals"});
  }
  plot.AddLine(std::move(line),
               {.color = SeriesColor(color), .label = has_band ? "median" : "reconstruction"});
  if (!true_line.empty()) plot.AddLine(std::move(true_line), kTruth);
  return plot.Svg();
}

}  // namespace

void AddFlockSection(const ReportData& data, Page* page, Missing* missing) {
  if (data.flock.empty()) {
    missing->push_back(data.run.trajectories
                           ? "Speeds and order of the flock: no file says how many frames a second "
                             "there are; give --fps."
                           : "Speeds and order of the flock: the folder has no trajectories.csv.");
    return;
  }
  page->BeginSection("flock", "How the flock moves");
  page->AddText(StepsText(data.run));
  const auto or_nan = [](const std::optional<double>& value) { return value.value_or(kNan); };
  const std::string truth_note =
      data.true_flock.empty() ? "" : " Dashed: the truth, animals outside the picture included.";
  page->BeginGrid(2);
  page->AddFigure(SpeedHistogram(data),
                  "Speeds of all animals in all frames; the highest half percent lies outside." +
                      std::string(data.true_flock.empty() ? "" : " Dashed: the truth."));
  page->AddFigure(
      OverTime(
          data, {.title = "Speed over time", .y_label = "speed [m/s]"}, 0,
          [](const auto& m) { return m.speed_low; }, [](const auto& m) { return m.speed_median; },
          [](const auto& m) { return m.speed_high; }),
      "Median speed, and the band that holds the middle 80 % of the animals.");
  page->AddFigure(
      OverTime(
          data, {.title = "Nearest neighbours", .y_label = "distance [m]", .y_low = 0}, 2,
          [&](const auto& m) { return or_nan(m.neighbour_low); },
          [&](const auto& m) { return or_nan(m.neighbour_median); },
          [&](const auto& m) { return or_nan(m.neighbour_high); }),
      "Distance from each animal to the nearest other one, in space. Errors of depth change it "
      "more than any other figure here." +
          truth_note);
  page->AddFigure(
      OverTime(
          data,
          {.title = "Polarisation",
           .y_label = "|mean direction of flight|",
           .y_low = 0,
           .y_high = 1},
          3, [](const auto&) { return kNan; },
          [&](const auto& m) { return or_nan(m.polarisation); }, [](const auto&) { return kNan; }),
      "1 when all fly the same way, near 0 in disorder." + truth_note);
  page->EndGrid();
}

}  // namespace flocklift
