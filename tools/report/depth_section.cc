// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "reconstruct/metrics/order_statistics.h"
#include "tools/plot/plot.h"
#include "tools/report/camera_depth.h"
#include "tools/report/sections.h"

namespace flocklift {
namespace {

constexpr std::size_t kSmallMultiples = 8;
constexpr int kMostMoments = 1500;
constexpr int kBridged = 6;  // frames; a line goes on over shorter gaps
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct FlockDepths {
  std::vector<BandPoint> spread;  // 10th to 90th percentile of the animals
  std::vector<Vec2d> median;
  std::vector<BandPoint> uncertainty;  // the median depth, +- the median sd
};

FlockDepths DepthsOfFlock(const RunFolder& run) {
  const FrameSpan span = SpanOf(*run.trajectories);
  const int stride = 1 + (span.last - span.first) / kMostMoments;
  std::map<int, std::pair<std::vector<double>, std::vector<double>>> frames;  // depths, sds
  for (const Trajectory& trajectory : run.trajectories->trajectories) {
    for (const TrajectoryPoint& point : trajectory.points) {
      if ((point.frame - span.first) % stride != 0) continue;
      auto& [depths, sds] = frames[point.frame];
      depths.push_back(DepthOf(*run.camera, point));
      if (point.sd_depth > 0) sds.push_back(point.sd_depth);
    }
  }
  FlockDepths flock;
  int previous = span.first;
  for (auto& [frame, values] : frames) {
    auto& [depths, sds] = values;
    const double time = run.TimeOf(frame);
    if (frame > previous + stride) {  // nobody there: a gap
      const double between = run.TimeOf(previous + 1);
      flock.spread.push_back({between, kNan, kNan});
      flock.median.push_back({between, kNan});
      flock.uncertainty.push_back({between, kNan, kNan});
    }
    previous = frame;
    std::sort(depths.begin(), depths.end());
    const double median = QuantileOfSorted(depths, 0.5);
    flock.spread.push_back({time, QuantileOfSorted(depths, 0.1), QuantileOfSorted(depths, 0.9)});
    flock.median.push_back({time, median});
    const double sd = Median(std::move(sds)).value_or(kNan);
    flock.uncertainty.push_back({time, median - sd, median + sd});
  }
  return flock;
}

// True depth of the animal that a result id stands for, by result id.
std::map<Id, std::vector<Vec2d>> TrueDepths(const ReportData& data) {
  std::map<Id, std::vector<Vec2d>> depths;
  if (!data.matched) return depths;
  std::map<Id, std::pair<Id, int>> last;
  for (const MatchedPoint& point : data.matched->points) {
    auto& line = depths[point.result_id];
    auto& [truth_id, frame] = last[point.result_id];
    if (!line.empty() && (truth_id != point.truth_id || point.frame > frame + kBridged)) {
      line.push_back({data.run.TimeOf(point.frame), kNan});
    }
    truth_id = point.truth_id;
    frame = point.frame;
    line.push_back({data.run.TimeOf(point.frame), point.truth_depth});
  }
  return depths;
}

std::string SmallMultiple(const ReportData& data, const Trajectory& trajectory,
                          const std::vector<Vec2d>* truth) {
  const RunFolder& run = data.run;
  Plot plot({.title = "Identity " + std::to_string(trajectory.id),
             .x_label = run.TimeLabel(),
             .y_label = "depth [m]",
             .width = 252,
             .height = 196});
  std::vector<BandPoint> one, two;
  std::vector<Vec2d> line;
  int previous = 0;
  for (const TrajectoryPoint& point : trajectory.points) {
    const double time = run.TimeOf(point.frame), depth = DepthOf(*run.camera, point);
    if (!line.empty() && point.frame > previous + kBridged) {
      line.push_back({time, kNan});
      one.push_back({time, kNan, kNan});
      two.push_back({time, kNan, kNan});
    }
    previous = point.frame;
    const double sd = point.sd_depth;
    line.push_back({time, depth});
    one.push_back({time, depth - sd, depth + sd});
    two.push_back({time, depth - 2 * sd, depth + 2 * sd});
  }
  const std::string color = SeriesColor(static_cast<std::size_t>(trajectory.id));
  if (run.trajectories->has_sd_depth) {
    plot.AddBand(std::move(two), {.color = color, .opacity = 0.12});
    plot.AddBand(std::move(one), {.color = color, .opacity = 0.22});
  }
  plot.AddLine(std::move(line), {.color = color});
  if (truth != nullptr) {
    plot.AddLine(*truth, {.color = "var(--ink)", .width = 1.2, .dash = "4 3"});
  }
  return plot.Svg();
}

// The identities with most points, by increasing id.
std::vector<const Trajectory*> LongestTrajectories(const Trajectories& trajectories) {
  std::vector<const Trajectory*> order;
  for (const Trajectory& trajectory : trajectories.trajectories) order.push_back(&trajectory);
  std::stable_sort(order.begin(), order.end(), [](const Trajectory* a, const Trajectory* b) {
    return a->points.size() > b->points.size();
  });
  order.resize(std::min(order.size(), kSmallMultiples));
  std::sort(order.begin(), order.end(),
            [](const Trajectory* a, const Trajectory* b) { return a->id < b->id; });
  return order;
}

}  // namespace

void AddDepthSection(const ReportData& data, Page* page, Missing* missing) {
  const RunFolder& run = data.run;
  if (!run.trajectories || run.trajectories->trajectories.empty() || !run.camera) {
    missing->push_back("Depth over time: it needs trajectories.csv and a camera file.");
    return;
  }
  page->BeginSection("depth", "Depth over time");
  const FlockDepths flock = DepthsOfFlock(run);
  const bool has_sd = run.trajectories->has_sd_depth;
  Plot plot({.title = "The flock as a whole",
             .x_label = run.TimeLabel(),
             .y_label = "depth [m]",
             .width = 1060,
             .height = 290});
  plot.AddBand(flock.spread, {.opacity = 0.16, .label = "80 % of the animals"});
  if (has_sd) {
    plot.AddBand(flock.uncertainty,
                 {.opacity = 0.3, .label = "median \xC2\xB1 1 sd of an animal's depth"});
  }
  plot.AddLine(flock.median, {.width = 2, .label = "median"});
  page->AddFigure(
      plot.Svg(),
      std::string("Depth is the distance along the camera's optical axis. Wide band: from the 10th "
                  "to the 90th percentile of the animals that are there.") +
          (has_sd ? " Narrow band: how well the depth of one animal is known, common scale "
                    "included."
                  : ""));

  const auto truth = TrueDepths(data);
  std::string text = fmt::format("The {} longest identities one by one",
                                 std::min(kSmallMultiples, run.trajectories->trajectories.size()));
  if (has_sd) text += ", with bands of one and two standard deviations";
  if (!truth.empty()) text += "; dashed: the truth";
  page->AddText(text + ". Each has a depth axis of its own.");
  page->BeginGrid(4);
  for (const Trajectory* trajectory : LongestTrajectories(*run.trajectories)) {
    const auto line = truth.find(trajectory->id);
    page->AddFigure(SmallMultiple(data, *trajectory, line == truth.end() ? nullptr : &line->second),
                    "");
  }
  page->EndGrid();
}

}  // namespace flocklift
