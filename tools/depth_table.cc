// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/depth_table.h"

#include <fmt/format.h>

#include <ctime>

#include "reconstruct/metrics/matched_points.h"
#include "simulate/core/check.h"

namespace flocklift {
namespace {

double Mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

template <typename Get>
double MeanOf(const DepthRow& row, const Get& get) {
  std::vector<double> values;
  for (const TrajectoryScores& scores : row.scores) values.push_back(get(scores));
  return Mean(values);
}

std::string Errors(double median, double p90) {
  return fmt::format("{:.1f} / {:.1f}", 100 * median, 100 * p90);
}

}  // namespace

const std::vector<DepthMethod>& DepthMethods() {
  static const std::vector<DepthMethod> methods = {
      {"batch"},
      {.name = "batch-no-size", .use_size = false},
      {"dynamics", ReconstructMethod::kDynamics},
      {.name = "dynamics-no-size", .method = ReconstructMethod::kDynamics, .use_size = false},
      {"cobyla", ReconstructMethod::kCobyla},
      {.name = "cobyla-current", .method = ReconstructMethod::kCobyla, .current_frame = true},
      {"lin-ceres", ReconstructMethod::kLinCeres},
      {.name = "lin-ceres-current", .method = ReconstructMethod::kLinCeres, .current_frame = true}};
  return methods;
}

DepthRun RunDepthMethod(const DepthMethod& method, const DepthTwin& twin, int threads) {
  ReconstructOptions options;
  options.method = method.method;
  options.knowledge = twin.knowledge;
  options.knowledge.use_size = method.use_size;
  options.cobyla.current_frame = method.current_frame;
  const std::clock_t begin = std::clock();
  ReconstructResult result = Reconstruct(options, twin.tracks, twin.camera, twin.fps, threads, {});
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  const MatchedTrajectories matched =
      MatchTrajectories({}, twin.camera, twin.truth, result.trajectories);
  const auto scores = ScoreTrajectories(
      matched, result.report.scale_sd > 0 ? std::optional(result.report.scale_sd) : std::nullopt);
  Check(scores.has_value(), "method " + method.name + " gave no depth");
  return {.scores = *scores,
          .cpu_ms = 1e3 * seconds / static_cast<double>(matched.truth_rows),
          .report = std::move(result.report),
          .result = std::move(result.trajectories)};
}

std::string DepthTable(const std::vector<DepthRow>& rows) {
  std::string text =
      "| scene | birds | method | error, % | after one scale, % | of constant depth's | order | "
      "coverage | ms per bird-frame |\n"
      "| --- | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n";
  std::string scene;
  for (const DepthRow& row : rows) {
    Check(!row.scores.empty(), "a row without a run");
    const std::string name = fmt::format("{} {}", row.scene, row.birds);
    if (name != scene) {
      scene = name;
      const std::string constant =
          Errors(MeanOf(row, [](const auto& s) { return s.constant_error_median; }),
                 MeanOf(row, [](const auto& s) { return s.constant_error_p90; }));
      text += fmt::format("| {} | {} | constant depth | {} | {} | 1 | | | |\n", row.scene,
                          row.birds, constant, constant);
    }
    const auto mean = [&](auto TrajectoryScores::*field) {
      return MeanOf(row, [field](const auto& s) { return static_cast<double>(s.*field); });
    };
    text += fmt::format(
        "| {} | {} | {} | {} | {} | {:.2f} | {:.2f} | {:.3f} | {:.2f} |\n", row.scene, row.birds,
        row.method,
        Errors(mean(&TrajectoryScores::error_median), mean(&TrajectoryScores::error_p90)),
        Errors(mean(&TrajectoryScores::scaled_error_median),
               mean(&TrajectoryScores::scaled_error_p90)),
        mean(&TrajectoryScores::skill),
        MeanOf(row, [](const auto& s) { return s.depth_spearman.value_or(0); }),
        mean(&TrajectoryScores::coverage), Mean(row.cpu_ms));
  }
  return text;
}

}  // namespace flocklift
