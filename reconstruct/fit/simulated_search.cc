// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/simulated_search.h"

#include <algorithm>
#include <cmath>

#include "simulate/core/parallel_for.h"

namespace flocklift::internal {
namespace {

constexpr double kSmallSpread = 3e-3;       // of a statistic's largest quantile: the least sd_q
constexpr double kHelps = 0.99;             // J after / before another round of BOBYQA
constexpr std::uint64_t kFirstSeed = 1000;  // of those at which the spread is taken

Quantiles AsArray(const MotionStatistics& statistics) {
  return Eigen::Map<const Quantiles>(statistics.data(),
                                     static_cast<Eigen::Index>(statistics.size()));
}

}  // namespace

Search::Search(const SimulatedFitOptions& options, const SimulatedStatistics& simulate,
               const MotionStatistics& data, const std::vector<double>& start,
               const Progress& progress)
    : options_(options),
      simulate_(simulate),
      data_(AsArray(data)),
      start_(start),
      progress_(progress) {
  const double end = std::log(options.range);
  low_.assign(start.size(), -end);
  high_.assign(start.size(), end);
  for (std::size_t k = 0; k < options.legal.size(); ++k) {
    low_[k] = std::max(low_[k], std::log(std::max(options.legal[k].low, 1e-300) / start[k]));
    high_[k] = std::min(high_[k], std::log(options.legal[k].high / start[k]));
  }
}

std::optional<Eigen::MatrixXd> Search::Simulate(const std::vector<double>& x, std::uint64_t first,
                                                int count) const {
  const std::vector<double> theta = Theta(x);
  std::vector<std::optional<MotionStatistics>> all(static_cast<std::size_t>(count));
  ParallelFor(options_.threads, 0, count, 1, [&](std::int64_t k, std::int64_t) {
    all[static_cast<std::size_t>(k)] =
        simulate_(theta, options_.seed + first + static_cast<std::uint64_t>(k));
  });
  Eigen::MatrixXd columns(data_.size(), count);
  for (int k = 0; k < count; ++k) {
    const auto& one = all[static_cast<std::size_t>(k)];
    if (!one) return std::nullopt;
    columns.col(k) = AsArray(*one);
  }
  return columns;
}

// sd_q, and the deviations from the mean that make C.
bool Search::TakeSpread(const std::vector<double>& x, Eigen::MatrixXd* spread) {
  const auto all = Simulate(x, kFirstSeed, options_.spread_seeds);
  if (!all) return false;
  *spread = all->colwise() - all->rowwise().mean();
  *spread /= std::sqrt(std::max(1, options_.spread_seeds - 1));
  floor_.resize(data_.size());
  const auto quantiles = static_cast<Eigen::Index>(kMotionQuantiles.size());
  for (Eigen::Index q = 0; q < data_.size(); q += quantiles) {
    const double largest = data_.segment(q, quantiles).abs().maxCoeff();
    const bool is_share =
        kMotionStatistics[static_cast<std::size_t>(q / quantiles)] == "polarisation";
    floor_.segment(q, quantiles) = kSmallSpread * (is_share ? std::max(largest, 1.0) : largest);
  }
  sd_ = spread->rowwise().norm().array().max(floor_).max(1e-12);
  return true;
}

double Search::Cost(const std::vector<double>& x) {
  ++evaluations_;
  Report(progress_, evaluations_, std::max(evaluations_, expected_));
  const auto all = Simulate(x, 0, options_.simulations);
  if (!all) return kImpossible;
  tried_.push_back({x, all->rowwise().mean().array()});
  const double cost = CostOf(tried_.back().mean);
  if (cost < best_cost_) {
    best_cost_ = cost;
    best_ = x;
  }
  return cost;
}

void Search::Optimize(nlopt::algorithm algorithm, int evaluations, std::vector<double>* x) {
  nlopt::srand(options_.seed);
  nlopt::opt solver(algorithm, static_cast<unsigned>(x->size()));
  solver.set_min_objective([](const std::vector<double>& at, std::vector<double>&,
                              void* search) { return static_cast<Search*>(search)->Cost(at); },
                           this);
  solver.set_lower_bounds(low_);
  solver.set_upper_bounds(high_);
  solver.set_xtol_abs(1e-3);
  if (algorithm == nlopt::LN_BOBYQA) {
    std::vector<double> step(x->size(), kFirstStep);
    for (std::size_t k = 0; k < step.size(); ++k) {
      step[k] = std::min(step[k], 0.4 * (high_[k] - low_[k]));
    }
    solver.set_initial_step(step);
  }
  // BOBYQA's model of J may have shrunk onto a wrinkle: it begins anew as long as that helps.
  const int end = evaluations_ + evaluations;
  double before = std::numeric_limits<double>::infinity();
  do {
    before = best_cost_;
    solver.set_maxeval(end - evaluations_);
    double cost = 0;
    try {
      solver.optimize(*x, cost);
    } catch (const nlopt::roundoff_limited&) {
      // The best that was tried counts.
    }
    *x = best_;
  } while (algorithm == nlopt::LN_BOBYQA && evaluations_ < end && best_cost_ < kHelps * before);
}

}  // namespace flocklift::internal
