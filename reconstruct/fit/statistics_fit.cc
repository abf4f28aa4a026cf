// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/statistics_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "reconstruct/fit/engine_flight.h"
#include "reconstruct/fit/flock_terms.h"
#include "reconstruct/fit/scene_terms.h"
#include "reconstruct/fit/simulated_fit.h"
#include "reconstruct/fit/target_distance.h"
#include "simulate/core/check.h"
#include "simulate/core/model_terms.h"
#include "simulate/core/suggest.h"

namespace flocklift::internal {
namespace {

constexpr double kMisfit = 2;  // sd from seed to seed: above, a statistic is not matched

// What is searched: the size of each number, which keeps its sign.
struct Sizes {
  std::vector<double> value, sign;
  std::vector<Range> legal;
};

Sizes SizesOf(const ModelSpec& model, const std::vector<std::string>& free) {
  Sizes sizes;
  for (const std::string& name : free) {
    const double* const value = FindNumber(model, name);
    const ParameterInfo* const info = FindParameter(model, name);
    if (value == nullptr || info == nullptr || !info->choices.empty()) {
      throw InputError("--free", 0,
                       "model " + model.name + " has no number `" + name + "` to be fitted",
                       SuggestName(name, NumberNames(model)));
    }
    if (*value == 0) {
      throw InputError(model.WhereOf(name), 0, "`" + name + "` cannot start from 0",
                       "give --set " + name + "=VALUE, of about the right size");
    }
    sizes.value.push_back(std::abs(*value));
    sizes.sign.push_back(*value < 0 ? -1 : 1);
    Range legal = info->range;
    if (*value < 0) legal = {.low = -legal.high, .high = -legal.low};
    sizes.legal.push_back({.low = std::max(legal.low, 0.0), .high = legal.high});
  }
  return sizes;
}

void AddWeights(const std::vector<std::string>& free, const std::vector<double>& sign,
                const SimulatedFit& fit, double known, FitResult* result) {
  ParameterPosterior& posterior = result->parameters.posterior;
  for (std::size_t k = 0; k < free.size(); ++k) {
    FittedWeight weight;
    weight.name = free[k];
    weight.value = weight.estimate = sign[k] * fit.estimate[k];
    weight.sd = fit.estimate[k] * fit.log_sd[k];
    weight.plain = std::nan("");
    weight.determined = 1.96 * fit.log_sd[k] < known;
    *FindNumber(&result->parameters.model, free[k]) = weight.value;
    posterior.free.push_back(weight.name);
    posterior.sd.push_back(weight.sd);
    posterior.determined.push_back(weight.determined);
    result->weights.push_back(weight);
  }
  const std::size_t p = fit.estimate.size();
  for (std::size_t a = 0; a < free.size(); ++a) {
    for (std::size_t b = 0; b < free.size(); ++b) {
      posterior.correlation.push_back(sign[a] * sign[b] * fit.correlation[a * p + b]);
    }
  }
}

}  // namespace

std::vector<std::string> StatisticsParameters(const ModelSpec& model) {
  std::vector<std::string> names;
  if (model.name == "bswarm") names = {"w_rep", "w_ali", "w_att", "r_rep", "r_ali", "r_att"};
  if (model.name == "lin") names = {"w_sep", "d_sep", "gain"};
  if (model.name == "opensteer") {
    names = {"separation_weight", "alignment_weight", "cohesion_weight",
             "separation_radius", "alignment_radius", "cohesion_radius"};
  }
  if (model.name == "shape") names = {"alpha", "w_dis", "s_max", "drag", "gain"};
  if (model.name == "morph") names = {"speed0", "omega1", "omega2", "departure_time"};
  if (model.name == "crowd") names = {"f_max", "f_min", "alpha", "gamma"};
  if (names.empty() && !model.terms.empty()) {
    const std::vector<std::string> terms = TermWeights(model);
    names = LinearWeights(model);
    std::erase_if(names, [&](const std::string& name) {  // they come below
      return std::find(terms.begin(), terms.end(), name) != terms.end();
    });
  }
  const std::vector<std::string> terms = TermNames(model.terms);
  for (std::size_t k = 0; k < terms.size(); ++k) {
    for (const char* size : {"gain", "rate", "g", "sd"}) {
      const std::string name = terms[k] + "." + size;
      if (FindParameter(model, name) != nullptr) names.push_back(name);
    }
  }
  if (!NeedsScene(model.name) && model.terms.empty()) return names;
  // What the scene leaves out is no part of it.
  std::erase_if(names, [&](const std::string& name) {
    const double* const number = FindNumber(model, name);
    return number != nullptr && *number == 0;
  });
  return names;
}

bool KnownByStatistics(const std::string& model) {
  return NeedsScene(model) || model == "bswarm" || model == "lin" || model == "opensteer";
}

bool NeedsScene(const std::string& model) {
  return model == "shape" || model == "morph" || model == "crowd";
}

FitResult FitStatistics(const FitOptions& options, const FitProblem& problem,
                        const Trajectories& trajectories, double fps, std::uint64_t seed,
                        int threads, const Progress& progress) {
  ModelSpec model = CompleteModel(problem.model);
  const std::vector<std::string> free =
      problem.free.empty() ? StatisticsParameters(model) : problem.free;
  if (free.empty()) {
    throw InputError(model.where, 0, "nothing is named to be fitted by statistics", "give --free");
  }
  if (NeedsScene(model.name) && !problem.scene) {
    throw InputError(model.where, 0,
                     "model " + model.name + " flies to what trajectories do not hold",
                     "give the scene that does: --scene SCENE.toml");
  }
  const Sizes sizes = SizesOf(model, free);
  std::vector<double> values = sizes.value;
  FitResult result;
  result.method = FitMethod::kStatistics;
  result.parameters.model = model;
  result.parameters.walls = problem.walls;
  result.animals = static_cast<int>(trajectories.trajectories.size());
  if (result.animals < 2) {
    result.status = FitStatus::kTooFewAnimals;
    return result;
  }
  const std::vector<FramePositions> frames = FramesOf(trajectories);
  const FlightStart start = MakeFlightStart(options, problem, frames, trajectories, fps);
  if (!problem.scene) result.parameters.goals = start.world.goals;
  result.frames = static_cast<int>(start.frames);
  TargetDistances target;
  if (problem.scene) target = MakeTargetDistances(start);
  const std::optional<MotionStatistics> data = ComputeMotionStatistics(
      std::span(frames).subspan(start.first, start.frames), 1 / fps, target);
  if (!data) {
    result.status = FitStatus::kTooFewFrames;
    return result;
  }
  // The speed that animals would fly alone, as a share of what they do fly, is one more unknown.
  const auto is_above_0 = [&](const char* name) {
    const double* const number = FindNumber(model, name);
    return number != nullptr && *number > 0;
  };
  const bool own_speed =
      is_above_0("drive") || is_above_0("cruise") || CruiseRateOfTerms(model) > 0;
  const auto simulate = [&](const std::vector<double>& theta, std::uint64_t of) {
    ModelSpec spec = model;
    for (std::size_t k = 0; k < free.size(); ++k) {
      *FindNumber(&spec, free[k]) = sizes.sign[k] * theta[k];
    }
    const auto flown = Fly(start, spec, own_speed ? theta.back() : 1, of);
    if (!flown) return std::optional<MotionStatistics>();
    return ComputeMotionStatistics(*flown, 1 / fps, target);
  };
  SimulatedFitOptions search;
  search.search = problem.search;
  search.global_evaluations = options.global_evaluations;
  search.local_evaluations = options.local_evaluations;
  search.range = options.search_range;
  search.legal = sizes.legal;
  search.seed = seed;
  search.threads = threads;
  if (own_speed) {
    values.push_back(1);
    search.legal.push_back({.low = 0});
    search.nuisance = 1;
  }
  const SimulatedFit fit = FitSimulated(search, simulate, *data, values, progress);
  if (!fit.usable) {
    throw InputError(model.where, 0, "the model does not fly from where the fit starts",
                     "give other values by --set");
  }
  result.rows = result.animals * static_cast<std::int64_t>(result.frames);
  AddWeights(free, sizes.sign, fit, search.known, &result);
  if (own_speed) {
    for (const double speed : start.swarm.cruising_speed) {
      result.own_speed_mean +=
          fit.estimate.back() * speed / static_cast<double>(start.swarm.cruising_speed.size());
    }
  }
  const std::size_t last = kMotionStatistics.size() - (target ? 0 : 1);  // the target's
  for (std::size_t k = 0; k < last; ++k) {
    result.misfit.push_back({std::string(kMotionStatistics[k]), fit.misfit[k]});
    if (!(fit.misfit[k] > kMisfit)) continue;
    result.warnings.push_back(
        fmt::format("the model's {} is {:.1f} times the spread from seed to seed off the data's",
                    kMotionStatistics[k], fit.misfit[k]));
  }
  return result;
}

}  // namespace flocklift::internal
