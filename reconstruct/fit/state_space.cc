// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/state_space.h"

#include <cmath>

#include "reconstruct/fit/scoring.h"
#include "simulate/core/check.h"

namespace flocklift {

StateSpaceFit FitStateSpace(const StateSpaceOptions& options, const ProcessModel& model,
                            const std::vector<double>& start, const FilterInput& input,
                            const DepthPaths* paths) {
  Check(start.size() == model.free.size(), "a start needs one value a parameter");
  Check(options.rounds > 0 && options.accuracy > 0, "scoring needs rounds and an accuracy");
  const auto& moments = input.second_differences();
  if (!(moments[0] > 0) || !std::isfinite(moments[1])) {
    StateSpaceFit none;
    none.status = StateSpaceStatus::kTooFew;
    return none;
  }
  return internal::Scoring(options, model, start, input, paths).Run();
}

std::vector<HeldScore> ScoreHeld(const StateSpaceOptions& options, const ProcessModel& model,
                                 const StateSpaceFit& fit, std::span<const double> held,
                                 const FilterInput& input, const DepthPaths* paths) {
  Check(fit.IsUsable() && model.free.size() == fit.estimate.size() + held.size(),
        "a score is of the parameters after those of a fit");
  std::vector<double> theta = fit.estimate;
  theta.insert(theta.end(), held.begin(), held.end());
  return internal::Scoring(options, model, theta, input, paths).Score(fit, fit.estimate.size());
}

}  // namespace flocklift
