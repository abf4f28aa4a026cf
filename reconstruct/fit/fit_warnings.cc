// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/fit_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "reconstruct/fit/flock_terms.h"

namespace flocklift {
namespace {

constexpr double kTooManyClamped = 0.3;  // share of rows at a speed limit
constexpr double kConfining = 0.05;      // share of the unexplained that pulls to the middle
constexpr double kContradicted = 4;      // sd by which the motion speaks against a held value

// Names the one that is contradicted most: when it is free, the others may be right.
void WarnOfHeld(FitResult* result) {
  const auto worst = std::max_element(
      result->held.begin(), result->held.end(),
      [](const HeldTest& a, const HeldTest& b) { return std::abs(a.z) < std::abs(b.z); });
  if (worst == result->held.end() || std::abs(worst->z) < kContradicted) return;
  std::string names;
  for (const FittedWeight& weight : result->weights) {
    if (weight.name != kGoalWeight) names += weight.name + ",";
  }
  result->warnings.push_back(
      fmt::format("{} is held at {:.4g}, and the motion speaks against that by {:.0f} standard "
                  "deviations, so that what is fitted may be wrong: free it too (--free {}{})",
                  worst->name, worst->value, std::abs(worst->z), names, worst->name));
}

}  // namespace

double MedianSdDepth(const Trajectories& trajectories) {
  std::vector<double> sds;
  for (const Trajectory& trajectory : trajectories.trajectories) {
    for (const TrajectoryPoint& point : trajectory.points) {
      if (point.sd_depth > 0) sds.push_back(point.sd_depth);
    }
  }
  if (sds.empty()) return 0;
  const auto middle = sds.begin() + static_cast<std::ptrdiff_t>(sds.size() / 2);
  std::nth_element(sds.begin(), middle, sds.end());
  return *middle;
}

void AddWarnings(const FitOptions& options, double pull, double median_sd_depth,
                 FitResult* result) {
  const auto warn = [&](std::string text) { result->warnings.push_back(std::move(text)); };
  if (result->method == FitMethod::kDifferences) {
    warn(
        "least squares on differences: the weights are biased, however long the data, and their "
        "standard deviations do not show it");
  }
  if (result->r2_held_out && *result->r2_held_out <= 0) {
    warn(
        fmt::format("on the last {:.0f} % of the time the model predicts accelerations no better "
                    "than constant velocity does (R^2 {:.3f}): it explains nothing",
                    100 * options.held_out, *result->r2_held_out));
  }
  if (!result->converged && result->method == FitMethod::kStateSpace) {
    warn("the likelihood's maximum was not reached: the weights are not final");
  } else if (!result->converged) {
    warn(
        "what the model leaves over has a memory that could not be estimated: the weights are "
        "biased");
  }
  std::string undetermined, negative, factors;
  for (const FittedWeight& weight : result->weights) {
    if (!weight.determined) undetermined += (undetermined.empty() ? " " : ", ") + weight.name;
    if (weight.estimate < 0 && weight.value == 0) {
      negative += fmt::format("{} {} ({:.2g} +- {:.2g})", negative.empty() ? "" : ",", weight.name,
                              weight.estimate, weight.sd);
    }
    if (weight.depth_factor) {
      factors += fmt::format("{} {} by {:.2f} +- {:.2f} (error is {:.0f} % of its term)",
                             factors.empty() ? "" : ",", weight.name, *weight.depth_factor,
                             *weight.depth_factor_sd, 100 * *weight.depth_share);
    }
  }
  if (!undetermined.empty()) warn("the data do not determine" + undetermined);
  if (!negative.empty()) warn("estimated below 0 and set to 0:" + negative);
  WarnOfHeld(result);
  const double used = static_cast<double>(result->rows + result->rows_mixed);
  const double clamped = static_cast<double>(result->rows_clamped + result->rows_mixed);
  if (clamped > kTooManyClamped * used) {
    warn(fmt::format("{:.0f} % of the speeds are at the model's limits: check s_min and s_max",
                     100 * clamped / used));
  }
  if (pull > kConfining) {
    warn(
        fmt::format("something that the model lacks holds the animals in place: a pull to the "
                    "middle is {:.0f} % of what it leaves over; if there are walls, give them",
                    100 * pull));
  }
  if (median_sd_depth > 0 && result->method == FitMethod::kStateSpace) {
    warn(
        fmt::format("depth errors (median sd {:.2g} m), taken for as large as stated and lasting "
                    "{:.3g} s, are estimated with the weights and in their standard deviations",
                    median_sd_depth, options.depth_error_time));
    return;
  }
  if (median_sd_depth > 0 && factors.empty()) {
    warn(
        fmt::format("depth errors (median sd {:.2g} m) distort the weights; by how much could not "
                    "be told",
                    median_sd_depth));
  } else if (median_sd_depth > 0) {
    warn(
        fmt::format("depth errors (median sd {:.2g} m) distort the weights beyond their standard "
                    "deviations: one more error of that size multiplies{}; the first one "
                    "may have done as much or more",
                    median_sd_depth, factors));
  }
}

}  // namespace flocklift
