// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "reconstruct/metrics/order_statistics.h"
#include "reconstruct/metrics/trajectory_scores.h"
#include "tools/plot/histogram.h"
#include "tools/plot/markup.h"
#include "tools/plot/plot.h"
#include "tools/plot/ticks.h"
#include "tools/report/sections.h"
#include "track/metrics/track_scores.h"

namespace flocklift {
namespace {

constexpr int kMostMoments = 1500;

std::optional<double> ScaleSd(const RunFolder& run) {
  const auto& scale_sd = run.Figure("reconstruct", "scale_sd");
  if (!scale_sd.is_number() || !(scale_sd.get<double>() > 0)) return std::nullopt;
  return scale_sd.get<double>();
}

std::string Percent(double share) { return NumberText(100 * share, 3) + " %"; }

void AddTrackScores(const RunFolder& run, Page* page) {
  const TrackScores s = ScoreTracks({}, *run.true_tracks, *run.tracks);
  page->AddTable(
      {{"Tracks", "HOTA", "DetA", "AssA", "LocA", "MOTA", "IDF1", "switches", "breaks", "recall",
        "precision", "identities / true"},
       {{"similarity from centre distance, 10 px", FixedText(s.hota.hota, 3),
         FixedText(s.hota.det_a, 3), FixedText(s.hota.ass_a, 3), FixedText(s.hota.loc_a, 3),
         FixedText(s.clear.mota, 3), FixedText(s.identity.idf1, 3),
         std::to_string(s.clear.id_switches), std::to_string(s.clear.fragmentations),
         FixedText(s.clear.recall, 3), FixedText(s.clear.precision, 3),
         fmt::format("{} / {}", s.result_ids, s.truth_ids)}}},
      "Tracks against the true ones. HOTA joins detection (DetA) and association (AssA); 1 is "
      "perfect.");
}

void AddDepthScores(const TrajectoryScores& s, Page* page) {
  const auto optional = [](const std::optional<double>& value, int decimals) {
    return value ? FixedText(*value, decimals) : std::string("n/a");
  };
  page->AddTable(
      {{"Depth error", "median", "90th percentile", "skill"},
       {{"as it is", Percent(s.error_median), Percent(s.error_p90), FixedText(s.skill, 2)},
        {"after one global scale (\xC3\x97 " + FixedText(s.scale, 3) + ")",
         Percent(s.scaled_error_median), Percent(s.scaled_error_p90), FixedText(s.scaled_skill, 2)},
        {"one depth for all: the true median", Percent(s.constant_error_median),
         Percent(s.constant_error_p90), "1"}}},
      "Error of depth relative to the true depth, of " + std::to_string(s.rows) +
          " points; each result identity stands for the animal that it follows in the "
          "image.");
  page->AddTable(
      {{},
       {{"animals in the picture that have a point",
         s.coverage_in_view ? Percent(*s.coverage_in_view) : "n/a"},
        {"order of depths (Spearman, mean over frames)", optional(s.depth_spearman, 3)},
        {"angle of flight to the true one, median [\xC2\xB0]", optional(s.velocity_angle, 1)},
        {"errors within 1 and 2 sd (right: 0.68, 0.95)",
         fmt::format("{}, {}", optional(s.within_1sd, 2), optional(s.within_2sd, 2))},
        {"the same, common scale taken out",
         fmt::format("{}, {}", optional(s.relative_within_1sd, 2),
                     optional(s.relative_within_2sd, 2))},
        {"error of the common scale, in its sd", optional(s.scale_z, 2)}}});
}

std::string ErrorHistogram(const std::vector<MatchedPoint>& points, double scale) {
  std::vector<double> as_is, scaled, sizes;
  for (const MatchedPoint& p : points) {
    as_is.push_back(100 * (p.result_depth / p.truth_depth - 1));
    scaled.push_back(100 * (scale * p.result_depth / p.truth_depth - 1));
    sizes.push_back(std::max(std::abs(as_is.back()), std::abs(scaled.back())));
  }
  const double bound = NiceRange(0, std::max(*Quantile(sizes, 0.995), 0.5), 6).high;
  Plot plot({.title = "Errors of depth",
             .x_label = "(reconstructed - true) / true depth [%]",
             .y_label = "share of points [%]",
             .width = 520,
             .height = 290,
             .x_low = -bound,
             .x_high = bound});
  plot.AddBars(MakeHistogram(as_is, -bound, bound, 41), {.opacity = 0.55, .label = "as it is"});
  plot.AddOutline(MakeHistogram(scaled, -bound, bound, 41),
                  {.color = "var(--c1)", .width = 1.8, .label = "after one scale"});
  plot.AddVerticalLine(0, {.color = "var(--muted)", .width = 1, .dash = "3 3"});
  return plot.Svg();
}

std::string DepthScatter(const std::vector<MatchedPoint>& points) {
  std::vector<Vec2d> dots;
  std::vector<double> depths;
  const std::size_t stride = 1 + points.size() / 4000;
  for (std::size_t k = 0; k < points.size(); ++k) {
    depths.push_back(points[k].truth_depth);
    depths.push_back(points[k].result_depth);
    if (k % stride == 0) dots.push_back({points[k].truth_depth, points[k].result_depth});
  }
  const AxisRange range = NiceRange(*Quantile(depths, 0.002), *Quantile(depths, 0.998), 6);
  Plot plot({.title = "Reconstructed against true depth",
             .x_label = "true depth [m]",
             .y_label = "reconstructed depth [m]",
             .width = 520,
             .height = 290,
             .x_low = range.low,
             .x_high = range.high,
             .y_low = range.low,
             .y_high = range.high});
  plot.AddPoints(std::move(dots), {.width = 2.2, .opacity = 0.55});
  plot.AddLine({{range.low, range.low}, {range.high, range.high}},
               {.color = "var(--ink)", .width = 1.2, .dash = "5 3", .label = "equal"});
  return plot.Svg();
}

std::string ErrorOverTime(const RunFolder& run, const std::vector<MatchedPoint>& points,
                          double scale) {
  std::map<int, std::pair<std::vector<double>, std::vector<double>>> frames;
  const FrameSpan span = SpanOf(*run.trajectories);
  const int stride = 1 + (span.last - span.first) / kMostMoments;
  for (const MatchedPoint& p : points) {
    if ((p.frame - span.first) % stride != 0) continue;
    auto& [as_is, scaled] = frames[p.frame];
    as_is.push_back(100 * std::abs(p.result_depth / p.truth_depth - 1));
    scaled.push_back(100 * std::abs(scale * p.result_depth / p.truth_depth - 1));
  }
  std::vector<BandPoint> band;
  std::vector<Vec2d> median, scaled_median;
  for (auto& [frame, errors] : frames) {
    const double time = run.TimeOf(frame);
    std::sort(errors.first.begin(), errors.first.end());
    band.push_back(
        {time, QuantileOfSorted(errors.first, 0.1), QuantileOfSorted(errors.first, 0.9)});
    median.push_back({time, QuantileOfSorted(errors.first, 0.5)});
    scaled_median.push_back({time, *Median(std::move(errors.second))});
  }
  Plot plot({.title = "Errors over time",
             .x_label = run.TimeLabel(),
             .y_label = "|depth error| [%]",
             .width = 520,
             .height = 290,
             .y_low = 0});
  plot.AddBand(std::move(band), {.opacity = 0.18, .label = "80 %"});
  plot.AddLine(std::move(median), {.label = "median"});
  plot.AddLine(std::move(scaled_median), {.color = "var(--c1)", .label = "after one scale"});
  return plot.Svg();
}

// Share of errors inside the central interval of each nominal probability.
std::string CalibrationCurve(const std::vector<MatchedPoint>& points, double scale,
                             std::optional<double> scale_sd) {
  std::vector<double> z, z_relative;
  for (const MatchedPoint& p : points) {
    if (!(p.sd_depth > 0)) continue;
    z.push_back(std::abs(p.result_depth - p.truth_depth) / p.sd_depth);
    if (!scale_sd) continue;
    const double common = *scale_sd * p.result_depth;
    const double rest = std::sqrt(
        std::max(p.sd_depth * p.sd_depth - common * common, 0.05 * 0.05 * p.sd_depth * p.sd_depth));
    z_relative.push_back(std::abs(scale * p.result_depth - p.truth_depth) / rest);
  }
  if (z.empty()) return "";
  std::sort(z.begin(), z.end());
  std::sort(z_relative.begin(), z_relative.end());
  const auto curve = [](const std::vector<double>& sorted) {
    std::vector<Vec2d> line;
    for (double bound = 0; bound <= 3.5; bound += 0.05) {
      const auto inside = std::lower_bound(sorted.begin(), sorted.end(), bound) - sorted.begin();
      line.push_back({100 * std::erf(bound / std::sqrt(2)),
                      100.0 * static_cast<double>(inside) / static_cast<double>(sorted.size())});
    }
    return line;
  };
  Plot plot({.title = "Are the error bars right?",
             .x_label = "interval's stated probability [%]",
             .y_label = "errors inside [%]",
             .width = 520,
             .height = 290,
             .x_low = 0,
             .x_high = 100,
             .y_low = 0,
             .y_high = 100});
  plot.AddLine({{0, 0}, {100, 100}},
               {.color = "var(--ink)", .width = 1.2, .dash = "5 3", .label = "right"});
  plot.AddLine(curve(z), {.label = "as stated"});
  if (!z_relative.empty()) {
    plot.AddLine(curve(z_relative), {.color = "var(--c1)", .label = "common scale taken out"});
  }
  return plot.Svg();
}

// scores.json alone: the truth itself is not there.
void AddScoresAsTold(const nlohmann::ordered_json& scores, Page* page) {
  page->BeginSection("truth", "Against the truth");
  for (const auto& [kind, figures] : scores.items()) {
    if (!figures.is_object() || kind == "round_trip") continue;  // which has its own section
    Table table{{kind, "score"}, {}};
    for (const auto& [name, value] : figures.items()) table.rows.push_back({name, JsonText(value)});
    page->AddTable(table, "As scores.json tells it; the truth itself is not in this folder.");
  }
}

}  // namespace

void AddTruthSection(const ReportData& data, Page* page, Missing* missing) {
  const RunFolder& run = data.run;
  const bool has_tracks = run.tracks && run.true_tracks;
  if (!has_tracks && !data.matched) {
    if (run.scores.is_object() && !run.scores.empty()) {
      AddScoresAsTold(run.scores, page);
      return;
    }
    missing->push_back(
        "Errors: no truth was found in truth/ of this folder or beside it (--truth names another "
        "folder).");
    return;
  }
  page->BeginSection("truth", "Against the truth");
  if (has_tracks) AddTrackScores(run, page);
  if (!data.matched) return;
  const std::vector<MatchedPoint>& points = data.matched->points;
  const auto scale_sd = ScaleSd(run);
  const auto scores = ScoreTrajectories(*data.matched, scale_sd);
  if (!scores) return;
  page->BeginGrid(2);
  AddDepthScores(*scores, page);
  page->EndGrid();
  page->BeginGrid(2);
  page->AddFigure(ErrorHistogram(points, scores->scale),
                  "Away from 0 as a whole: the common scale is off, which one camera cannot see. "
                  "Outline: the same errors once all depths are multiplied by one best factor.");
  page->AddFigure(DepthScatter(points),
                  "Each dot one animal in one frame. A straight cloud off the dashed line is an "
                  "error of scale; its width is the error of relative depth.");
  page->AddFigure(ErrorOverTime(run, points, scores->scale),
                  "Size of the errors over time: median, and the band of the middle 80 % of the "
                  "animals.");
  const std::string calibration = CalibrationCurve(points, scores->scale, scale_sd);
  if (!calibration.empty()) {
    page->AddFigure(calibration,
                    "Share of errors inside an interval, against the probability that sd_depth "
                    "gives to it. Below the diagonal the error bars are too small. The errors of "
                    "one scene share its scale, so \"as stated\" may lie far off by chance.");
  }
  page->EndGrid();
}

}  // namespace flocklift
