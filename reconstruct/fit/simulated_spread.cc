// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How far the parameters of a simulated fit may be from the best.

#include <algorithm>
#include <cmath>
#include <limits>

#include "reconstruct/fit/simulated_search.h"

namespace flocklift::internal {
namespace {

constexpr double kUnfelt = 1e-9;          // of the largest eigenvalue of G' W G
constexpr double kSmallPart = 0.05;       // of a unit vector
constexpr double kNearEnd = 0.05;         // of log theta
constexpr double kInterval = 1.96;        // sd, of a 95 % interval
constexpr double kExcluded = 3;           // sd: farther away nothing may be as good
constexpr double kLeastChallenge = 0.01;  // of log theta

}  // namespace

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
  const Eigen::MatrixXd least_part = m * (floor_ / sd_).matrix().asDiagonal();
  const Eigen::MatrixXd covariance =
      Lack(spread) * ((1 + 1.0 / options_.simulations) * part * part.transpose() +
                      least_part * least_part.transpose());
  fit->correlation.assign(static_cast<std::size_t>(p * p), 0);
  for (Eigen::Index a = 0; a < p; ++a) {
    // A direction that nothing feels leaves all that have a part in it unknown.
    bool felt = true;
    for (Eigen::Index d = 0; d < p; ++d) {
      felt = felt &&
             (eigen.eigenvalues()[d] > least || std::abs(eigen.eigenvectors()(a, d)) < kSmallPart);
    }
    fit->log_sd.push_back(felt ? std::sqrt(covariance(a, a))
                               : std::numeric_limits<double>::infinity());
    for (Eigen::Index b = 0; b < p; ++b) {
      const double scale = std::sqrt(covariance(a, a) * covariance(b, b));
      fit->correlation[static_cast<std::size_t>(a * p + b)] = a == b      ? 1
                                                              : scale > 0 ? covariance(a, b) / scale
                                                                          : 0;
    }
  }
}

// J of data that are any one of the spread's seeds.
Eigen::ArrayXd Search::CostOfSeeds(const Eigen::MatrixXd& spread) const {
  const double factor = (1 + 1.0 / options_.simulations) * (options_.spread_seeds - 1);
  return factor * ((1 / sd_).matrix().asDiagonal() * spread).colwise().squaredNorm().array() +
         (floor_ / sd_).square().sum();
}

// Of all that was tried, by the sd_q at hand.
double Search::BestCost() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Trial& trial : tried_) least = std::min(least, CostOf(trial.mean));
  return least;
}

// How many times the J of such data the best J is: 1 or more.
double Search::Lack(const Eigen::MatrixXd& spread) const {
  return std::max(1.0, BestCost() / std::max(CostOfSeeds(spread).mean(), 1e-300));
}

// J of data that are any one of those seeds, at most. Or the best J and its noise, which is its
// range over those seeds: the search may end above them. Where the best J is above them because the
// model is not the truth, as much more as it is above them.
double Search::Acceptable(const Eigen::MatrixXd& spread) const {
  const Eigen::ArrayXd of_seeds = CostOfSeeds(spread);
  const double most = of_seeds.maxCoeff() + (floor_ / sd_).square().sum();
  const double least = BestCost();
  return std::max({most, least + of_seeds.maxCoeff() - of_seeds.minCoeff(),
                   least * most / std::max(of_seeds.mean(), 1e-300)});
}

void Search::Cover(const std::vector<double>& x, double acceptable,
                   std::vector<double>* log_sd) const {
  for (const Trial& trial : tried_) {
    if (CostOf(trial.mean) > acceptable) continue;
    for (std::size_t k = 0; k < x.size(); ++k) {
      (*log_sd)[k] = std::max((*log_sd)[k], std::abs(trial.x[k] - x[k]) / kInterval);
    }
  }
}

// From the best that was tried there, and from x moved just there and to the middle.
bool Search::Challenge(const std::vector<double>& x, std::size_t k, double offset,
                       double acceptable) {
  std::vector<double> low = low_, high = high_, step(x.size(), kFirstStep);
  if (x[k] + offset < low[k] || x[k] + offset > high[k]) return false;  // nothing is there
  (offset > 0 ? low : high)[k] = x[k] + offset;
  step[k] = std::min(step[k], 0.4 * (high[k] - low[k]));
  std::vector<std::vector<double>> starts = {x, x};
  starts[0][k] += offset;
  starts[1][k] = (low[k] + high[k]) / 2;  // there may be a hill before it
  const Trial* best = nullptr;
  for (const Trial& trial : tried_) {
    if (trial.x[k] < low[k] || trial.x[k] > high[k]) continue;
    if (best == nullptr || CostOf(trial.mean) < CostOf(best->mean)) best = &trial;
  }
  if (best != nullptr) starts.insert(starts.begin(), best->x);
  expected_ = evaluations_ + static_cast<int>(starts.size()) * options_.challenge_evaluations;
  for (std::vector<double>& start : starts) {
    nlopt::opt solver(nlopt::LN_BOBYQA, static_cast<unsigned>(x.size()));
    solver.set_min_objective([](const std::vector<double>& at, std::vector<double>&,
                                void* search) { return static_cast<Search*>(search)->Cost(at); },
                             this);
    solver.set_lower_bounds(low);
    solver.set_upper_bounds(high);
    solver.set_initial_step(step);
    solver.set_maxeval(options_.challenge_evaluations);
    solver.set_xtol_abs(1e-3);
    solver.set_stopval(acceptable);
    double cost = kImpossible;
    try {
      solver.optimize(start, cost);
    } catch (const nlopt::roundoff_limited&) {
      continue;  // nothing better near there
    }
    if (cost <= acceptable) return true;
  }
  return false;
}

void Search::Widen(const std::vector<double>& x, const Eigen::MatrixXd& spread,
                   std::vector<double>* log_sd) {
  const double acceptable = Acceptable(spread);
  const double end = std::log(options_.range), near = options_.known + kNearEnd;
  for (std::size_t k = 0; k < x.size(); ++k) {
    // What ends near where the search had to is not known to end there; where the model does, it
    // is.
    if ((low_[k] == -end && x[k] < near - end) || (high_[k] == end && x[k] > end - near)) {
      (*log_sd)[k] = std::numeric_limits<double>::infinity();
    }
  }
  Cover(x, acceptable, log_sd);
  for (std::size_t k = 0; k + static_cast<std::size_t>(options_.nuisance) < x.size(); ++k) {
    while (kInterval * (*log_sd)[k] <= options_.known) {
      const double off =
          std::min(std::max(kExcluded * (*log_sd)[k], kLeastChallenge), 1.01 * options_.known);
      if (!Challenge(x, k, -off, acceptable) && !Challenge(x, k, off, acceptable)) break;
      Cover(x, acceptable, log_sd);
    }
  }
}

}  // namespace flocklift::internal
