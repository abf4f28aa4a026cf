// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <unordered_map>

#include "reconstruct/metrics/order_statistics.h"
#include "tools/plot/markup.h"
#include "tools/plot/plot.h"
#include "tools/report/sections.h"

namespace flocklift {
namespace {

constexpr std::size_t kMostMoments = 1500;

struct Divergence {
  std::vector<Vec2d> median;
  std::vector<BandPoint> band;
};

// Distance between each replayed animal and the reconstructed one of its id, by frame.
Divergence ComputeDivergence(const RunFolder& run) {
  std::unordered_map<Id, const Trajectory*> by_id;
  for (const Trajectory& trajectory : run.trajectories->trajectories) {
    by_id[trajectory.id] = &trajectory;
  }
  std::map<int, std::vector<double>> frames;
  for (const Trajectory& replayed : run.replay->trajectories) {
    const auto found = by_id.find(replayed.id);
    if (found == by_id.end()) continue;
    auto point = found->second->points.begin();
    const auto end = found->second->points.end();
    for (const TrajectoryPoint& now : replayed.points) {
      while (point != end && point->frame < now.frame) ++point;
      if (point == end) break;
      if (point->frame == now.frame) {
        frames[now.frame].push_back(Norm(now.position - point->position));
      }
    }
  }
  Divergence divergence;
  for (auto& [frame, distances] : frames) {
    std::sort(distances.begin(), distances.end());
    const double time = run.TimeOf(frame);
    divergence.median.push_back({time, QuantileOfSorted(distances, 0.5)});
    divergence.band.push_back(
        {time, QuantileOfSorted(distances, 0.1), QuantileOfSorted(distances, 0.9)});
  }
  return divergence;
}

template <typename Value>
std::string Compare(const ReportData& data, const std::vector<FlockStatistics>& replayed,
                    PlotOptions options, Value value) {
  options.x_label = data.run.TimeLabel();
  options.width = 520;
  options.height = 260;
  Plot plot(std::move(options));
  const auto line = [&](const std::vector<FlockStatistics>& flock) {
    std::vector<Vec2d> points;
    for (const FlockStatistics& moment : flock) {
      if (const auto y = value(moment)) points.push_back({data.run.TimeOf(moment.frame), *y});
    }
    return points;
  };
  plot.AddLine(line(data.flock), {.label = "reconstruction"});
  plot.AddLine(line(replayed), {.color = "var(--c1)", .label = "replay"});
  return plot.Svg();
}

}  // namespace

void AddReplaySection(const ReportData& data, Page* page, Missing* missing) {
  const RunFolder& run = data.run;
  if (!run.replay || run.replay->trajectories.empty()) {
    missing->push_back("Replay: the folder has no replay/trajectories.csv.");
    return;
  }
  page->BeginSection("replay", "Replay through the fitted model");
  page->AddText(
      "The reconstructed flock at one moment, flown on by the fitted model alone. How soon it "
      "parts "
      "from the reconstruction says how much of the motion the model explains.");
  page->BeginGrid(2);
  if (run.trajectories) {
    const Divergence divergence = ComputeDivergence(run);
    if (divergence.median.size() > 1) {
      Plot plot({.title = "Divergence",
                 .x_label = run.TimeLabel(),
                 .y_label = "distance [m]",
                 .width = 520,
                 .height = 260,
                 .y_low = 0});
      plot.AddBand(divergence.band,
                   {.color = "var(--c1)", .opacity = 0.18, .label = "80 % of the animals"});
      plot.AddLine(divergence.median, {.color = "var(--c1)", .label = "median"});
      page->AddFigure(plot.Svg(),
                      "Distance between each replayed animal and the reconstructed one of the same "
                      "identity.");
    }
  }
  if (run.replay->has_velocity && !data.flock.empty()) {
    const StatesByFrame states(*run.replay);
    const auto replayed =
        ComputeFlockStatistics(states, static_cast<int>(1 + states.frames().size() / kMostMoments));
    page->AddFigure(Compare(data, replayed,
                            {.title = "Polarisation",
                             .y_label = "|mean direction of flight|",
                             .y_low = 0,
                             .y_high = 1},
                            [](const FlockStatistics& m) { return m.polarisation; }),
                    "Order of the flock, reconstructed and replayed.");
    page->AddFigure(
        Compare(data, replayed, {.title = "Speed", .y_label = "median speed [m/s]"},
                [](const FlockStatistics& m) { return std::optional<double>(m.speed_median); }),
        "Median speed, reconstructed and replayed.");
    page->AddFigure(
        Compare(data, replayed,
                {.title = "Nearest neighbours", .y_label = "median distance [m]", .y_low = 0},
                [](const FlockStatistics& m) { return m.neighbour_median; }),
        "Distance to the nearest neighbour, reconstructed and replayed.");
  }
  page->EndGrid();
}

}  // namespace flocklift
