// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/metrics/trajectory_scores.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "reconstruct/metrics/order_statistics.h"

namespace flocklift {
namespace {

constexpr int kFewestForOrder = 5;   // animals in a frame, for a rank correlation
constexpr int kFewestForExtent = 3;  // for a depth range

struct FrameDepths {
  std::vector<double> truth, result;
};

std::map<int, FrameDepths> DepthsByFrame(const std::vector<MatchedPoint>& points) {
  std::map<int, FrameDepths> frames;
  for (const MatchedPoint& point : points) {
    frames[point.frame].truth.push_back(point.truth_depth);
    frames[point.frame].result.push_back(point.result_depth);
  }
  return frames;
}

// f of each point.
template <typename Function>
std::vector<double> Each(const std::vector<MatchedPoint>& points, Function f) {
  std::vector<double> values;
  values.reserve(points.size());
  for (const MatchedPoint& point : points) values.push_back(f(point));
  return values;
}

std::optional<double> MeanDepthOrder(const std::map<int, FrameDepths>& frames) {
  double sum = 0;
  int counted = 0;
  for (const auto& [frame, depths] : frames) {
    if (depths.truth.size() < kFewestForOrder) continue;
    if (const auto rho = SpearmanCorrelation(depths.truth, depths.result)) {
      sum += *rho;
      ++counted;
    }
  }
  if (counted == 0) return std::nullopt;
  return sum / counted;
}

double MedianExtent(const std::map<int, FrameDepths>& frames) {
  std::vector<double> extents;
  for (const auto& [frame, depths] : frames) {
    if (depths.truth.size() < kFewestForExtent) continue;
    const auto [low, high] = std::minmax_element(depths.truth.begin(), depths.truth.end());
    extents.push_back(*high - *low);
  }
  return Median(std::move(extents)).value_or(std::numeric_limits<double>::quiet_NaN());
}

// Motion from one frame to the next, of the animals that are matched in both.
std::optional<double> MedianVelocityAngle(const std::vector<MatchedPoint>& points) {
  std::vector<double> angles;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const MatchedPoint &here = points[k], &next = points[k + 1];
    if (here.truth_id != next.truth_id || next.frame != here.frame + 1) continue;
    const Vec3d truth = next.truth_in_world - here.truth_in_world;
    const Vec3d result = next.result_in_world - here.result_in_world;
    const double norms = Norm(truth) * Norm(result);
    if (!(norms > 0)) continue;
    const double cosine = std::clamp(Dot(truth, result) / norms, -1.0, 1.0);
    angles.push_back(std::acos(cosine) * 180 / std::numbers::pi);
  }
  return Median(std::move(angles));
}

double ShareBelow(const std::vector<double>& values, double limit) {
  const auto below =
      std::count_if(values.begin(), values.end(), [limit](double value) { return value < limit; });
  return static_cast<double>(below) / static_cast<double>(values.size());
}

void Calibrate(const std::vector<MatchedPoint>& points, std::optional<double> scale_sd,
               TrajectoryScores* scores) {
  std::vector<double> z_absolute, z_relative;
  for (const MatchedPoint& point : points) {
    const double sd = point.sd_depth;
    if (!(sd > 0) || !std::isfinite(sd)) continue;
    z_absolute.push_back(std::abs(point.result_depth - point.truth_depth) / sd);
    if (!scale_sd) continue;
    const double common = *scale_sd * point.result_depth;
    const double rest = std::sqrt(std::max(sd * sd - common * common, 0.05 * 0.05 * sd * sd));
    z_relative.push_back(std::abs(scores->scale * point.result_depth - point.truth_depth) / rest);
  }
  if (z_absolute.empty()) return;
  scores->within_1sd = ShareBelow(z_absolute, 1);
  scores->within_2sd = ShareBelow(z_absolute, 2);
  if (z_relative.empty()) return;
  scores->relative_within_1sd = ShareBelow(z_relative, 1);
  scores->relative_within_2sd = ShareBelow(z_relative, 2);
  if (*scale_sd > 0) scores->scale_z = (1 / scores->scale - 1) / *scale_sd;
}

}  // namespace

std::optional<TrajectoryScores> ScoreTrajectories(const MatchedTrajectories& matched,
                                                  std::optional<double> scale_sd) {
  const std::vector<MatchedPoint>& points = matched.points;
  if (points.empty()) return std::nullopt;
  TrajectoryScores s;
  s.rows = static_cast<std::int64_t>(points.size());
  s.coverage = static_cast<double>(s.rows) / static_cast<double>(matched.truth_rows);
  if (matched.truth_rows_in_view > 0) {
    s.coverage_in_view = static_cast<double>(matched.matched_rows_in_view) /
                         static_cast<double>(matched.truth_rows_in_view);
  }
  s.scale = *Median(Each(points, [](const auto& p) { return p.truth_depth / p.result_depth; }));
  const double constant = *Median(Each(points, [](const auto& p) { return p.truth_depth; }));

  const auto absolute = [](const MatchedPoint& p) {
    return std::abs(p.result_depth - p.truth_depth);
  };
  const auto scaled = [&](const MatchedPoint& p) {
    return std::abs(s.scale * p.result_depth - p.truth_depth);
  };
  const auto relative = Each(points, [&](const auto& p) { return absolute(p) / p.truth_depth; });
  const auto scaled_relative =
      Each(points, [&](const auto& p) { return scaled(p) / p.truth_depth; });
  const auto of_constant = Each(
      points, [&](const auto& p) { return std::abs(constant - p.truth_depth) / p.truth_depth; });
  s.error_median = *Median(relative);
  s.error_p90 = *Quantile(relative, 0.9);
  s.scaled_error_median = *Median(scaled_relative);
  s.scaled_error_p90 = *Quantile(scaled_relative, 0.9);
  s.constant_error_median = *Median(of_constant);
  s.constant_error_p90 = *Quantile(of_constant, 0.9);
  s.skill = s.error_median / s.constant_error_median;
  s.scaled_skill = s.scaled_error_median / s.constant_error_median;

  const std::map<int, FrameDepths> frames = DepthsByFrame(points);
  s.extent = MedianExtent(frames);
  s.error_over_extent = *Median(Each(points, absolute)) / s.extent;
  s.scaled_error_over_extent = *Median(Each(points, scaled)) / s.extent;
  s.depth_spearman = MeanDepthOrder(frames);
  s.velocity_angle = MedianVelocityAngle(points);
  Calibrate(points, scale_sd, &s);
  return s;
}

std::vector<std::pair<std::string, double>> Figures(const TrajectoryScores& s) {
  std::vector<std::pair<std::string, double>> figures;
  const auto add = [&](const char* name, std::optional<double> value) {
    if (value && std::isfinite(*value)) figures.emplace_back(name, *value);
  };
  add("rows", static_cast<double>(s.rows));
  add("coverage", s.coverage);
  add("coverage_in_view", s.coverage_in_view);
  add("constant_err_median_pct", 100 * s.constant_error_median);
  add("constant_err_p90_pct", 100 * s.constant_error_p90);
  add("skill", s.skill);
  add("scaled_skill", s.scaled_skill);
  add("depth_err_median_pct", 100 * s.error_median);
  add("depth_err_p90_pct", 100 * s.error_p90);
  add("scaled_err_median_pct", 100 * s.scaled_error_median);
  add("scaled_err_p90_pct", 100 * s.scaled_error_p90);
  add("scale", s.scale);
  add("err_over_extent", s.error_over_extent);
  add("extent_m", s.extent);
  add("scaled_err_over_extent", s.scaled_error_over_extent);
  add("depth_spearman", s.depth_spearman);
  add("velocity_angle_median_deg", s.velocity_angle);
  add("within_1sd", s.within_1sd);
  add("within_2sd", s.within_2sd);
  add("relative_within_1sd", s.relative_within_1sd);
  add("relative_within_2sd", s.relative_within_2sd);
  add("scale_z", s.scale_z);
  return figures;
}

}  // namespace flocklift
