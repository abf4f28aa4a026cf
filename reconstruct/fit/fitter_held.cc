// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>

#include "reconstruct/fit/fitter.h"
#include "reconstruct/fit/process_model.h"
#include "simulate/core/model_terms.h"

namespace flocklift::internal {
namespace {

// A held value off by this share of itself is right, however well the motion tells.
constexpr double kRight = 1e-5;

}  // namespace

std::vector<std::string> Fitter::HeldOf(const std::vector<std::string>& names) const {
  std::vector<std::string> held;
  for (const std::string& name : names) {
    const bool of_walls = name == "alpha_b" || name == "wall_taper" || name.starts_with("walls");
    if (of_walls && !problem_.walls) continue;
    if (std::find(free_.begin(), free_.end(), name) == free_.end()) held.push_back(name);
  }
  return held;
}

void Fitter::ScoreHeldParameters(const StateSpaceOptions& options, const StateSpaceFit& states,
                                 const FilterInput& input, const DepthPaths* paths) {
  const std::vector<std::string> held = HeldOf(SmoothParameters(model_));
  if (held.empty()) return;
  std::vector<std::string> all = free_;
  all.insert(all.end(), held.begin(), held.end());
  std::vector<double> values;
  for (const std::string& name : held) values.push_back(*FindNumber(model_, name));
  const std::vector<HeldScore> scores =
      ScoreHeld(options, MakeProcessModel(model_, all, problem_.walls, around_), states, values,
                input, paths);
  for (std::size_t k = 0; k < held.size(); ++k) {
    const double sd = scores[k].z != 0 ? scores[k].change / scores[k].z : 0;
    const double z = sd > 0 ? scores[k].change / std::hypot(sd, kRight * values[k]) : 0;
    result_.held.push_back({.name = held[k], .value = values[k], .z = z});
  }
}

void Fitter::TestHeldWeights() {
  const std::vector<std::string> held = HeldOf(LinearWeights(model_));
  if (held.empty() || result_.method == FitMethod::kDifferences) return;
  std::vector<std::string> all = terms_.free;
  all.insert(all.end(), held.begin(), held.end());
  const FlockTerms terms =
      MakeFlockTerms(model_, all, problem_.walls, goal_, cruising_speed_, around_);
  const MotionRows rows =
      BuildMotionRows({.window = window_, .substeps = options_.substeps, .threads = threads_},
                      terms, flock_, middles_);
  WhiteningOptions whitening = whitening_;
  whitening.own_speed = terms.has_own_speed;
  const WhitenedFit fit = SolveWhitened(whitening, rows);
  if (!fit.IsUsable()) return;
  for (std::size_t k = 0; k < held.size(); ++k) {
    const std::size_t at = terms_.free.size() + k;
    const double value = *FindNumber(model_, held[k]);
    const double z = (fit.regression.estimate[at] - value) / fit.regression.sd[at];
    result_.held.push_back({.name = held[k], .value = value, .z = std::isfinite(z) ? z : 0});
  }
}

}  // namespace flocklift::internal
