// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/simulated_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlopt.hpp>

#include "simulate/core/check.h"
#include "simulate/core/parallel_for.h"

namespace flocklift {
namespace {

using Quantiles = Eigen::Array<double, Eigen::Dynamic, 1>;

constexpr double kImpossible = 1e12;        // J where a simulation has no statistics
constexpr double kSmallSpread = 1e-3;       // of a statistic's size: the least sd_q
constexpr double kUnfelt = 1e-9;            // of the largest eigenvalue of G' W G
constexpr double kSmallPart = 0.05;         // of a unit vector
constexpr double kNearEnd = 0.05;           // of log theta
constexpr std::uint64_t kFirstSeed = 1000;  // of those at which the spread is taken

Quantiles AsArray(const MotionStatistics& statistics) {
  return Eigen::Map<const Quantiles>(statistics.data(),
                                     static_cast<Eigen::Index>(statistics.size()));
}

class Search {
 public:
  Search(const SimulatedFitOptions& options, const SimulatedStatistics& simulate,
         const MotionStatistics& data, const std::vector<double>& start, const Progress& progress)
      : options_(options),
        simulate_(simulate),
        data_(AsArray(data)),
        start_(start),
        progress_(progress) {}

  SimulatedFit Run();

 private:
  std::vector<double> Theta(const std::vector<double>& x) const {
    std::vector<double> theta = start_;
    for (std::size_t k = 0; k < theta.size(); ++k) theta[k] *= std::exp(x[k]);
    return theta;
  }
  // One column a seed; nothing when one has no statistics.
  std::optional<Eigen::MatrixXd> Simulate(const std::vector<double>& x, std::uint64_t first,
                                          int count) const;
  bool TakeSpread(const std::vector<double>& x, Eigen::MatrixXd* spread);
  double CostOf(const Quantiles& mean) const { return ((mean - data_) / sd_).square().sum(); }
  double Cost(const std::vector<double>& x);
  // How far from x, in each, parameters were tried that are as good as the truth may be.
  std::vector<double> Reach(const std::vector<double>& x, const Eigen::MatrixXd& spread) const;
  void Optimize(nlopt::algorithm algorithm, int evaluations, std::vector<double>* x);
  void Summarize(const std::vector<double>& x, const Eigen::MatrixXd& spread, SimulatedFit* fit);

  const SimulatedFitOptions& options_;
  const SimulatedStatistics& simulate_;
  const Quantiles data_;
  const std::vector<double>& start_;
  const Progress& progress_;
  Quantiles sd_;
  struct Trial {
    std::vector<double> x;
    Quantiles mean;
  };
  std::vector<Trial> tried_;
  std::vector<double> best_;  // of them
  double best_cost_ = std::numeric_limits<double>::infinity();
  int evaluations_ = 0;
};

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
  sd_ = spread->rowwise().norm().array().max(kSmallSpread * data_.abs()).max(1e-12);
  return true;
}

double Search::Cost(const std::vector<double>& x) {
  Report(progress_, ++evaluations_, options_.global_evaluations + options_.local_evaluations);
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
  solver.set_lower_bounds(-std::log(options_.range));
  solver.set_upper_bounds(std::log(options_.range));
  solver.set_maxeval(evaluations);
  solver.set_xtol_abs(1e-3);
  if (algorithm == nlopt::LN_BOBYQA) solver.set_initial_step(0.15);
  double cost = 0;
  try {
    solver.optimize(*x, cost);
  } catch (const nlopt::roundoff_limited&) {
    // The best that was tried counts.
  }
  *x = best_;
}

// As good: J no greater than it is for data that are any one of the spread's seeds.
std::vector<double> Search::Reach(const std::vector<double>& x,
                                  const Eigen::MatrixXd& spread) const {
  const double factor = (1 + 1.0 / options_.simulations) * (options_.spread_seeds - 1);
  const double limit =
      factor * ((1 / sd_).matrix().asDiagonal() * spread).colwise().squaredNorm().maxCoeff();
  std::vector<double> reach(x.size(), 0);
  for (const Trial& trial : tried_) {
    if (CostOf(trial.mean) > limit) continue;
    for (std::size_t k = 0; k < x.size(); ++k) {
      reach[k] = std::max(reach[k], std::abs(trial.x[k] - x[k]));
    }
  }
  const double end = std::log(options_.range);
  for (std::size_t k = 0; k < x.size(); ++k) {
    // What ends where the search had to is not known to end there.
    if (std::abs(x[k]) > end - kNearEnd) reach[k] = std::numeric_limits<double>::infinity();
  }
  return reach;
}

void Search::Summarize(const std::vector<double>& x, const Eigen::MatrixXd& spread,
                       SimulatedFit* fit) {
  const auto p = static_cast<Eigen::Index>(x.size());
  const auto here = Simulate(x, 0, options_.simulations);
  if (here) {
    const Quantiles z = (here->rowwise().mean().array() - data_) / sd_;
    const Eigen::Index n = static_cast<Eigen::Index>(kMotionQuantiles.size());
    for (std::size_t k = 0; k < fit->misfit.size(); ++k) {
      fit->misfit[k] = std::sqrt(z.segment(static_cast<Eigen::Index>(k) * n, n).square().mean());
    }
  }
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(data_.size(), p);
  for (Eigen::Index c = 0; c < p; ++c) {
    std::vector<double> up = x, down = x;
    up[static_cast<std::size_t>(c)] += options_.difference;
    down[static_cast<std::size_t>(c)] -= options_.difference;
    const auto high = Simulate(up, 0, options_.simulations);
    const auto low = Simulate(down, 0, options_.simulations);
    if (!high || !low) continue;  // unfelt, as far as can be said
    slopes.col(c) = (high->rowwise().mean() - low->rowwise().mean()) / (2 * options_.difference);
  }
  const Eigen::MatrixXd weighted = (1 / sd_).matrix().asDiagonal() * slopes;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(weighted.transpose() * weighted);
  const double least = kUnfelt * std::max(eigen.eigenvalues().maxCoeff(), 1e-300);
  const Eigen::VectorXd inverse = eigen.eigenvalues().cwiseMax(least).cwiseInverse();
  const Eigen::MatrixXd m = eigen.eigenvectors() * inverse.asDiagonal() *
                            eigen.eigenvectors().transpose() * weighted.transpose();
  const Eigen::MatrixXd part = m * ((1 / sd_).matrix().asDiagonal() * spread);
  const Eigen::MatrixXd covariance = (1 + 1.0 / options_.simulations) * part * part.transpose();
  const std::vector<double> reach = Reach(x, spread);
  fit->correlation.assign(static_cast<std::size_t>(p * p), 0);
  for (Eigen::Index a = 0; a < p; ++a) {
    // A direction that nothing feels leaves all that have a part in it unknown.
    bool felt = true;
    for (Eigen::Index d = 0; d < p; ++d) {
      felt = felt &&
             (eigen.eigenvalues()[d] > least || std::abs(eigen.eigenvectors()(a, d)) < kSmallPart);
    }
    fit->log_sd.push_back(
        felt ? std::max(std::sqrt(covariance(a, a)), reach[static_cast<std::size_t>(a)] / 1.96)
             : std::numeric_limits<double>::infinity());
    for (Eigen::Index b = 0; b < p; ++b) {
      const double scale = std::sqrt(covariance(a, a) * covariance(b, b));
      fit->correlation[static_cast<std::size_t>(a * p + b)] = a == b      ? 1
                                                              : scale > 0 ? covariance(a, b) / scale
                                                                          : 0;
    }
  }
}

SimulatedFit Search::Run() {
  SimulatedFit fit;
  std::vector<double> x(start_.size(), 0);
  Eigen::MatrixXd spread;
  fit.estimate = start_;
  if (!TakeSpread(x, &spread)) return fit;
  fit.start_cost = Cost(x);
  if (!(fit.start_cost < kImpossible)) return fit;
  if (options_.search != SimulatedSearch::kBobyqa) {
    Optimize(options_.search == SimulatedSearch::kCrs ? nlopt::GN_CRS2_LM : nlopt::GN_ISRES,
             options_.global_evaluations, &x);
  }
  Optimize(nlopt::LN_BOBYQA, options_.local_evaluations, &x);
  fit.cost = best_cost_;
  if (!TakeSpread(x, &spread)) return fit;
  fit.usable = true;
  fit.estimate = Theta(x);
  fit.evaluations = evaluations_;
  Summarize(x, spread, &fit);
  return fit;
}

}  // namespace

SimulatedFit FitSimulated(const SimulatedFitOptions& options, const SimulatedStatistics& simulate,
                          const MotionStatistics& data, const std::vector<double>& start,
                          const Progress& progress) {
  Check(options.range > 1 && options.simulations > 0 && options.spread_seeds > 1,
        "a simulated fit needs a range above 1, a simulation, and two seeds");
  Check(!start.empty() && std::all_of(start.begin(), start.end(), [](double v) { return v > 0; }),
        "a simulated fit starts from values above 0");
  return Search(options, simulate, data, start, progress).Run();
}

}  // namespace flocklift
