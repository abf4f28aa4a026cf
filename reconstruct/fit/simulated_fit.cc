// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/simulated_fit.h"

#include <algorithm>

#include "reconstruct/fit/simulated_search.h"
#include "simulate/core/check.h"

namespace flocklift {
namespace internal {

SimulatedFit Search::Run() {
  SimulatedFit fit;
  std::vector<double> x(start_.size(), 0);
  Eigen::MatrixXd spread;
  fit.estimate = start_;
  if (!TakeSpread(x, &spread)) return fit;
  expected_ = options_.global_evaluations + options_.local_evaluations;
  fit.start_cost = Cost(x);
  if (!(fit.start_cost < kImpossible)) return fit;
  if (options_.search != SimulatedSearch::kBobyqa) {
    Optimize(options_.search == SimulatedSearch::kCrs ? nlopt::GN_CRS2_LM : nlopt::GN_ISRES,
             options_.global_evaluations, &x);
  }
  Optimize(nlopt::LN_BOBYQA, options_.local_evaluations, &x);
  if (options_.search != SimulatedSearch::kBobyqa && Lack(spread) > 1) {
    std::vector<double> again(start_.size(), 0);
    expected_ += options_.local_evaluations;
    Optimize(nlopt::LN_BOBYQA, options_.local_evaluations, &again);
    x = best_;
  }
  fit.cost = best_cost_;
  if (!TakeSpread(x, &spread)) return fit;
  fit.usable = true;
  fit.estimate = Theta(x);
  Summarize(x, spread, &fit);
  Widen(x, spread, &fit.log_sd);
  fit.evaluations = evaluations_;
  return fit;
}

}  // namespace internal

SimulatedFit FitSimulated(const SimulatedFitOptions& options, const SimulatedStatistics& simulate,
                          const MotionStatistics& data, const std::vector<double>& start,
                          const Progress& progress) {
  Check(options.range > 1 && options.simulations > 0 && options.spread_seeds > 1,
        "a simulated fit needs a range above 1, a simulation, and two seeds");
  Check(!start.empty() && std::all_of(start.begin(), start.end(), [](double v) { return v > 0; }),
        "a simulated fit starts from values above 0");
  return internal::Search(options, simulate, data, start, progress).Run();
}

}  // namespace flocklift
