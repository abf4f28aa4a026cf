// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/fitter.h"

#include <algorithm>
#include <cmath>

#include "reconstruct/fit/central_differences.h"
#include "reconstruct/fit/fit_measures.h"
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
  u_ = Unexplained(rows, values, whitening_.own_speed);
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
    if (rms[c] == 0 && model_.parameters.contains(weight.name)) {
      weight.value = weight.estimate = model_.parameters.at(weight.name);
    }
    result_.weights.push_back(weight);
  }
  result_.best = BestDirection(fit.regression, rms);
  result_.worst = WorstDirection(fit.regression, rms);
}

bool Fitter::IsPositive(const std::string& name) const {
  const ModelInfo* const info = FindModel(model_.name);
  const auto found = std::find_if(info->parameters.begin(), info->parameters.end(),
                                  [&](const ParameterInfo& i) { return i.name == name; });
  return found == info->parameters.end() || found->range.low == 0;
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

  const auto& parameters = result_.parameters.model.parameters;
  std::vector<double> values;
  double cruise = whitening_.own_speed ? parameters.at("cruise") : 0;
  for (const FittedWeight& weight : result_.weights) {
    values.push_back(weight.value);
    if (weight.name == "cruise") cruise = weight.value;
  }
  if (!(cruise > 0)) return;
  double sum = 0, squares = 0, count = 0;
  for (const double factor : OwnFactors(rows, values, flock_.animals())) {
    if (std::isnan(factor)) continue;
    const double speed = cruising_speed_ + factor / (cruise / parameters.at("time_unit"));
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
    parameters[weight.name] = weight.value;
  }
  if (goal_ && result_.weights.back().value > 0) {
    result_.parameters.goals = {*goal_};
    result_.parameters.goals[0].weight = result_.weights.back().value;
  }
  if (parameters.contains("noise") && parameters.contains("time_unit")) {
    const double unit = parameters.at("time_unit");
    parameters["noise"] = result_.noise_sd * unit * unit;
    parameters["noise_time"] = result_.noise_time / unit;
  }
  if (parameters.contains("diffusion")) parameters["diffusion"] = result_.diffusion;
}

}  // namespace flocklift::internal
