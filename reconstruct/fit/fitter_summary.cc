// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/fitter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "reconstruct/fit/central_differences.h"
#include "reconstruct/fit/fit_measures.h"
#include "reconstruct/fit/scene_terms.h"
#include "simulate/core/model_terms.h"
#include "simulate/flock/model.h"

namespace flocklift::internal {
namespace {

// A weight is determined when its 95 % interval leaves 0 out, or when all of the interval would
// change accelerations by less than this share of what the model explains.
constexpr double kSmallShare = 0.25;
// A radius or another parameter that is no weight, when its interval is within this share of it.
constexpr double kRadiusShare = 0.25;

}  // namespace

void Fitter::SummarizeWeights(const WhitenedFit& fit) {
  const MotionRows& rows = rows_;
  const std::vector<double>& theta = fit.regression.estimate;
  const std::size_t p = theta.size();
  std::vector<double> rms = parameter_rms_;
  rms.resize(p);
  for (std::size_t c = 0; c < rows.terms; ++c) {
    std::vector<Vec3d> term;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      term.push_back(rows.features[k * (rows.terms + 1) + c]);
    }
    rms[c] = std::sqrt(MeanSquare(term));
  }
  std::vector<Vec3d> explained;
  for (std::size_t k = 0; k < rows.size(); ++k) explained.push_back(rows.response[k] - u_[k]);
  result_.acceleration_sd = std::sqrt(MeanSquare(rows.response));
  const double small =
      kSmallShare * std::min(std::sqrt(MeanSquare(explained)), result_.acceleration_sd);

  WhiteningOptions least_squares = whitening_;
  least_squares.lagged = false;
  const WhitenedFit plain =
      SolveWhitened(least_squares, CentralDifferenceRows(terms_, flock_, middles_));
  std::vector<bool> positive;
  std::vector<std::string> names = terms_.free;
  names.insert(names.end(), free_.begin() + static_cast<std::ptrdiff_t>(weights_), free_.end());
  for (const std::string& name : names) positive.push_back(IsPositive(name));
  const std::vector<double> values =
      ProbableWeights(fit.regression, rms, result_.acceleration_sd, positive);
  u_ = Unexplained(rows, WeightsOf(values), whitening_.own_speed);
  for (std::size_t c = 0; c < p; ++c) {
    FittedWeight weight;
    weight.name = names[c];
    weight.estimate = theta[c];
    weight.sd = fit.regression.sd[c];
    const bool linear = c < rows.terms;
    weight.plain = linear && plain.IsUsable() ? plain.regression.estimate[c] : std::nan("");
    const double half_width = 1.96 * weight.sd;
    const double known = (linear ? 1 : kRadiusShare) * std::abs(weight.estimate);
    weight.determined = std::isfinite(weight.sd) && fit.converged &&
                        (half_width < known || (linear && half_width * rms[c] < small));
    weight.value = values[c];
    // A term that never acted keeps the value it started with.
    const double* const start = FindNumber(model_, weight.name);
    if (rms[c] == 0 && start != nullptr) weight.value = weight.estimate = *start;
    result_.weights.push_back(weight);
  }
  result_.best = BestDirection(fit.regression, rms);
  result_.worst = WorstDirection(fit.regression, rms);
}

bool Fitter::IsPositive(const std::string& name) const {
  const ParameterInfo* const info = FindParameter(model_, name);
  return info == nullptr || info->range.low == 0;
}

double Fitter::CruiseRate() const {
  ModelSpec model = model_;
  for (const FittedWeight& weight : result_.weights) {
    if (double* const number = FindNumber(&model, weight.name)) *number = weight.value;
  }
  const double rate = CruiseRateOfTerms(model);
  const auto own = model.parameters.find("cruise");
  if (own == model.parameters.end()) return rate;
  return rate + own->second / model.parameters.at("time_unit");
}

void Fitter::SummarizeRest(const WhitenedFit& fit) {
  const MotionRows& rows = rows_;
  result_.converged = fit.converged;
  result_.rows = static_cast<std::int64_t>(rows.size());
  result_.rows_mixed = rows.mixed;
  result_.rows_clamped = std::count(rows.clamped.begin(), rows.clamped.end(), true);
  result_.condition = fit.regression.condition;
  result_.residual_sd = std::sqrt(MeanSquare(u_));
  result_.r2 = 1 - MeanSquare(u_) / std::max(MeanSquare(rows.response), 1e-300);
  std::vector<Vec3d> own = u_;
  if (whitening_.frame_effects) RemoveFrameMeans(rows, &own);
  const double step = flock_.dt() / std::max(1, options_.substeps);
  const NoiseEstimate noise = EstimateNoise(rows, own, fit.rho, flock_.dt(), step);
  result_.noise_sd = noise.sd;
  result_.noise_time = noise.time;
  if (result_.diffusion_sd) {
    result_.noise_sd = std::sqrt(2 * result_.diffusion / step);
    result_.noise_time = 0;
    return;  // smooth models know no speeds of the animals' own
  }
  result_.diffusion = noise.diffusion;

  std::vector<double> values;
  for (const FittedWeight& weight : result_.weights) values.push_back(weight.value);
  const double cruise = whitening_.own_speed ? CruiseRate() : 0;
  if (!(cruise > 0)) return;
  double sum = 0, squares = 0, count = 0;
  for (const double factor : OwnFactors(rows, values, flock_.animals())) {
    if (std::isnan(factor)) continue;
    const double speed = cruising_speed_ + factor / cruise;
    sum += speed;
    squares += speed * speed;
    count += 1;
  }
  if (count == 0) return;
  result_.own_speed_mean = sum / count;
  result_.own_speed_sd = std::sqrt(std::max(0.0, squares / count - sum / count * (sum / count)));
}

void Fitter::WriteParametersOf(const WhitenedFit& fit) {
  auto& parameters = result_.parameters.model.parameters;
  ParameterPosterior& posterior = result_.parameters.posterior;
  const std::size_t p = result_.weights.size(), of_model = free_.size();
  for (std::size_t c = 0; c < of_model; ++c) {
    const FittedWeight& weight = result_.weights[c];
    posterior.free.push_back(weight.name);
    posterior.sd.push_back(weight.sd);
    posterior.determined.push_back(weight.determined);
    for (std::size_t d = 0; d < of_model; ++d) {
      posterior.correlation.push_back(fit.regression.correlation[c * p + d]);
    }
    *FindNumber(&result_.parameters.model, weight.name) = weight.value;
  }
  if (goal_ && result_.weights.back().value > 0) {
    result_.parameters.goals = {*goal_};
    result_.parameters.goals[0].weight = result_.weights.back().value;
  }
  const auto is_goal = [](const ModelSpec& term) { return term.name == "goal"; };
  if (std::any_of(model_.terms.begin(), model_.terms.end(), is_goal)) {
    result_.parameters.goals = around_.goals;
  }
  if (parameters.contains("noise") && parameters.contains("time_unit")) {
    const double unit = parameters.at("time_unit");
    parameters["noise"] = result_.noise_sd * unit * unit;
    parameters["noise_time"] = result_.noise_time / unit;
  }
  if (parameters.contains("diffusion")) parameters["diffusion"] = result_.diffusion;
  // The first term of noise is all that is left over.
  double sd = parameters.contains("noise") ? 0 : result_.noise_sd;
  for (ModelSpec& term : result_.parameters.model.terms) {
    if (term.name != "noise") continue;
    term.parameters["sd"] = std::exchange(sd, 0);
    term.parameters["time"] = result_.noise_time;
  }
}

}  // namespace flocklift::internal
