// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/whitened_fit.h"

#include <algorithm>
#include <cmath>

namespace flocklift {
namespace {

constexpr int kMaxSteps = 50;
constexpr double kMaxRho = 0.999;

// The first `terms` of a regression, with their estimates replaced.
RegressionResult Leading(const RegressionResult& all, std::size_t terms,
                         const std::vector<double>& estimate) {
  const std::size_t p = all.sd.size();
  RegressionResult result = all;
  result.estimate.assign(estimate.begin(), estimate.begin() + static_cast<std::ptrdiff_t>(terms));
  result.sd.resize(terms);
  result.feature_rms.resize(terms);
  result.correlation.clear();
  for (std::size_t i = 0; i < terms; ++i) {
    for (std::size_t j = 0; j < terms; ++j) {
      result.correlation.push_back(all.correlation[i * p + j]);
    }
  }
  return result;
}

// Residuals after a step: e less the features times the step.
double DepthVariance(const RegressionRows& rows, const std::vector<double>& step,
                     const std::vector<double>& depth_sd) {
  const auto p = static_cast<std::size_t>(rows.terms);
  std::vector<double> squares(rows.size());
  double across = 0, across_count = 0;
  for (std::size_t e = 0; e < rows.size(); ++e) {
    double u = rows.response[e];
    for (std::size_t c = 0; c < p; ++c) u -= rows.features[e * p + c] * step[c];
    squares[e] = u * u;
    if (e % 3 != 0) {
      across += squares[e];
      across_count += 1;
    }
  }
  if (across_count == 0 || across == 0) return 0;
  across /= across_count;
  double product = 0, square = 0;
  for (std::size_t e = 0; e < rows.size(); e += 3) {
    const double variance = depth_sd[e] * depth_sd[e];
    product += variance * (squares[e] - across);
    square += variance * variance;
  }
  return square > 0 ? std::max(0.0, product / square) / across : 0;
}

}  // namespace

WhitenedFit SolveWhitened(const WhiteningOptions& options, const MotionRows& rows) {
  WhitenedFit fit;
  // The weights, and the mean of the animals' own unknowns.
  const std::size_t p = rows.terms + (HasMeanOwn(options) ? 1 : 0);
  std::vector<double> depth_sd;
  RegressionRows white =
      WhitenRows(options, rows, std::vector<double>(p, 0.0), 0, false, &depth_sd);
  fit.regression = SolveRegression(white);
  std::vector<double> theta = fit.regression.estimate;
  if (fit.IsUsable() && options.sight) fit.depth_variance = DepthVariance(white, theta, depth_sd);
  fit.regression = Leading(fit.regression, rows.terms, theta);
  if (!fit.IsUsable()) return fit;
  if (!options.lagged || !options.memory) return fit;

  const int lag = 2 * rows.window + 3;
  std::vector<Vec3d> u = Unexplained(rows, fit.regression.estimate, options.own_speed);
  if (options.frame_effects) RemoveFrameMeans(rows, &u);
  const LagCorrelation near = CorrelationAtLag(rows, u, lag);
  if (near.pairs == 0 || near.value < 5 / std::sqrt(3.0 * static_cast<double>(near.pairs))) {
    return fit;
  }
  const LagCorrelation far = CorrelationAtLag(rows, u, lag + rows.window);
  double rho = std::clamp(far.value / near.value, 0.0, kMaxRho);
  WhitenedFit remembering = fit;
  remembering.converged = false;
  for (int step = 0; step < kMaxSteps && !remembering.converged; ++step) {
    white = WhitenRows(options, rows, theta, rho, true, &depth_sd);
    const RegressionResult regression = SolveRegression(white);
    if (!regression.IsUsable()) return fit;
    // Half steps later on: whole ones may jump to and fro across the solution.
    const double length = step < 8 ? 1 : 0.5;
    double largest = 0;
    for (std::size_t c = 0; c < p; ++c) {
      theta[c] += length * regression.estimate[c];
      if (std::isfinite(regression.sd[c]) && regression.sd[c] > 0) {
        largest = std::max(largest, std::abs(regression.estimate[c]) / regression.sd[c]);
      }
    }
    const double before = rho;
    rho = std::clamp(rho + length * std::clamp(regression.estimate[p], -0.3, 0.3), 0.0, kMaxRho);
    largest = std::max(largest, std::abs(rho - before) * 100);
    remembering.converged = largest < 1e-3;
    remembering.regression = Leading(regression, rows.terms, theta);
    remembering.rho = rho;
    if (options.sight) {
      remembering.depth_variance = DepthVariance(white, regression.estimate, depth_sd);
    }
  }
  if (!remembering.converged) {
    fit.converged = false;
    return fit;
  }
  return remembering;
}

}  // namespace flocklift
