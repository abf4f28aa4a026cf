// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <algorithm>

#include "reconstruct/metrics/order_statistics.h"
#include "reconstruct/metrics/trajectory_scores.h"
#include "tools/plot/markup.h"
#include "tools/report/camera_depth.h"
#include "tools/report/sections.h"
#include "track/metrics/track_scores.h"

namespace flocklift {
namespace {

std::string Percent(double share, int digits = 2) { return NumberText(100 * share, digits) + " %"; }

// Each animal's row count by frame: how many are there at once.
template <typename Animals, typename Rows>
std::vector<double> CountsByFrame(const Animals& animals, FrameSpan span, Rows rows_of) {
  std::vector<double> counts(std::max(0, span.last - span.first + 1), 0);
  for (const auto& animal : animals) {
    for (const auto& row : rows_of(animal)) ++counts[row.frame - span.first];
  }
  return counts;
}

Card AnimalsCard(const RunFolder& run) {
  std::vector<double> counts;
  std::size_t identities = 0;
  if (run.trajectories) {
    identities = run.trajectories->trajectories.size();
    counts = CountsByFrame(
        run.trajectories->trajectories, SpanOf(*run.trajectories),
        [](const auto& t) -> const auto& { return t.points; });
  } else {
    identities = run.tracks->tracklets.size();
    counts = CountsByFrame(
        run.tracks->tracklets, SpanOf(*run.tracks),
        [](const auto& t) -> const auto& { return t.detections; });
  }
  const double most = counts.empty() ? 0 : *std::max_element(counts.begin(), counts.end());
  return {NumberText(Median(counts).value_or(0), 4), "Animals at once, median",
          fmt::format("most {}; {} identities in all", NumberText(most, 7), identities)};
}

void AddDepthCards(const ReportData& data, std::vector<Card>* cards) {
  const RunFolder& run = data.run;
  if (!run.trajectories || !run.camera) return;
  std::vector<double> depths, relative;
  for (const Trajectory& trajectory : run.trajectories->trajectories) {
    for (const TrajectoryPoint& point : trajectory.points) {
      const double depth = DepthOf(*run.camera, point);
      depths.push_back(depth);
      if (point.sd_depth > 0 && depth > 0) relative.push_back(point.sd_depth / depth);
    }
  }
  if (depths.empty()) return;
  std::sort(depths.begin(), depths.end());
  cards->push_back(
      {NumberText(QuantileOfSorted(depths, 0.5)) + " m", "Distance along the axis",
       fmt::format("80 % between {} and {} m", NumberText(QuantileOfSorted(depths, 0.1)),
                   NumberText(QuantileOfSorted(depths, 0.9)))});
  if (relative.empty()) return;
  const auto& scale_sd = run.Figure("reconstruct", "scale_sd");
  std::string note = "1 sd, median";
  if (scale_sd.is_number() && scale_sd.get<double>() > 0) {
    note += "; of which common scale " + Percent(scale_sd.get<double>());
  }
  cards->push_back({"\xC2\xB1 " + Percent(*Median(relative)), "Depth uncertainty", note});
}

void AddFlockCards(const ReportData& data, std::vector<Card>* cards) {
  if (data.flock.empty()) return;
  std::vector<double> speeds, distances, polarisations;
  for (const FlockStatistics& moment : data.flock) {
    speeds.push_back(moment.speed_median);
    if (moment.neighbour_median) distances.push_back(*moment.neighbour_median);
    if (moment.polarisation) polarisations.push_back(*moment.polarisation);
  }
  cards->push_back(
      {NumberText(*Median(speeds)) + " m/s", "Speed, median", "over animals and time"});
  if (!distances.empty()) {
    cards->push_back(
        {NumberText(*Median(distances)) + " m", "Nearest neighbour, median", "distance in space"});
  }
  if (!polarisations.empty()) {
    cards->push_back(
        {FixedText(*Median(polarisations), 2), "Polarisation, median", "1: all fly the same way"});
  }
}

void AddTruthCards(const ReportData& data, std::vector<Card>* cards) {
  const RunFolder& run = data.run;
  if (run.tracks && run.true_tracks) {
    const TrackScores scores = ScoreTracks({}, *run.true_tracks, *run.tracks);
    cards->push_back({FixedText(scores.hota.hota, 3), "Tracking against the truth: HOTA",
                      fmt::format("IDF1 {}; identity switches: {}",
                                  FixedText(scores.identity.idf1, 3), scores.clear.id_switches)});
  }
  if (!data.matched) return;
  if (const auto scores = ScoreTrajectories(*data.matched, std::nullopt)) {
    cards->push_back(
        {Percent(scores->error_median), "Depth error, median",
         fmt::format("{} after one global scale; coverage {}", Percent(scores->scaled_error_median),
                     Percent(scores->coverage_in_view.value_or(scores->coverage), 3))});
  }
}

}  // namespace

void AddSummarySection(const ReportData& data, Page* page) {
  std::vector<Card> cards = {AnimalsCard(data.run)};
  AddDepthCards(data, &cards);
  AddFlockCards(data, &cards);
  AddTruthCards(data, &cards);
  page->BeginSection("summary", "Summary");
  page->AddCards(cards);
}

void AddWarnings(const ReportData& data, Page* page) {
  for (const StageSummary& summary : data.run.summaries) {
    if (!summary.json.is_object()) continue;
    const auto warnings = summary.json.find("warnings");
    if (warnings == summary.json.end() || !warnings->is_array()) continue;
    for (const auto& warning : *warnings) {
      page->AddNote(summary.stage + ": " + JsonText(warning));
    }
  }
}

}  // namespace flocklift
