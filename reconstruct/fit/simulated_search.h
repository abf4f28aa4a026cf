// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The search of a simulated fit (simulated_fit.h), and what it leaves to say of its result: what
// was simulated, by NLopt (simulated_search.cc), and how far the parameters may be from the best
// (simulated_spread.cc).

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_SIMULATED_SEARCH_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_SIMULATED_SEARCH_H_

#include <Eigen/Dense>
#include <limits>
#include <nlopt.hpp>
#include <optional>
#include <vector>

#include "reconstruct/fit/simulated_fit.h"

namespace flocklift::internal {

using Quantiles = Eigen::Array<double, Eigen::Dynamic, 1>;

inline constexpr double kImpossible = 1e12;  // J where a simulation has no statistics
inline constexpr double kFirstStep = 0.15;   // of log theta, BOBYQA's

class Search {
 public:
  Search(const SimulatedFitOptions& options, const SimulatedStatistics& simulate,
         const MotionStatistics& data, const std::vector<double>& start, const Progress& progress);

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
  void Optimize(nlopt::algorithm algorithm, int evaluations, std::vector<double>* x);
  void Summarize(const std::vector<double>& x, const Eigen::MatrixXd& spread, SimulatedFit* fit);
  Eigen::ArrayXd CostOfSeeds(const Eigen::MatrixXd& spread) const;
  double BestCost() const;
  double Lack(const Eigen::MatrixXd& spread) const;
  // The largest J of parameters that may be the truth.
  double Acceptable(const Eigen::MatrixXd& spread) const;
  // Raises the sd to what was tried and is acceptable.
  void Cover(const std::vector<double>& x, double acceptable, std::vector<double>* log_sd) const;
  // Is anything acceptable where parameter k is off x by `offset` or more?
  bool Challenge(const std::vector<double>& x, std::size_t k, double offset, double acceptable);
  void Widen(const std::vector<double>& x, const Eigen::MatrixXd& spread,
             std::vector<double>* log_sd);

  const SimulatedFitOptions& options_;
  const SimulatedStatistics& simulate_;
  const Quantiles data_;
  const std::vector<double>& start_;
  const Progress& progress_;
  std::vector<double> low_, high_;  // of log theta
  Quantiles sd_, floor_;            // sd_q, and what it is at least
  struct Trial {
    std::vector<double> x;
    Quantiles mean;
  };
  std::vector<Trial> tried_;
  std::vector<double> best_;  // of them
  double best_cost_ = std::numeric_limits<double>::infinity();
  int evaluations_ = 0, expected_ = 0;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_SIMULATED_SEARCH_H_
