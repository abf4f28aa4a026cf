// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/swarm_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "reconstruct/fit/noise_search.h"
#include "reconstruct/fit/observed_flock.h"
#include "simulate/core/check.h"
#include "simulate/core/suggest.h"
#include "simulate/flock/model.h"

namespace flocklift::internal {
namespace {

constexpr std::size_t kMostSamples = 4;
constexpr double kKnown = 0.25;     // a parameter whose interval is within this share is determined
constexpr double kGoodShare = 0.9;  // of the mean square of velocities that noise alone explains
constexpr double kManyLeftOut = 0.05;

double AtAxis(const Vec3d& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

void CheckProblem(const FitProblem& problem, const ModelSpec& model,
                  const std::vector<std::string>& free) {
  if (problem.method != FitMethod::kAuto && problem.method != FitMethod::kNoiseField) {
    throw InputError(model.where, 0, "model swarm has no accelerations to fit",
                     "take --method noise-field");
  }
  if (model.choices.at("noise") != "curl") {
    throw InputError(model.WhereOf("noise"), 0, "only curl noise can be fitted", "");
  }
  const std::vector<std::string> known = {"scale", "gain"};
  for (const std::string& name : free) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw InputError("--free", 0, "`" + name + "` of model swarm cannot be freed",
                       SuggestName(name, known));
    }
  }
  if (std::find(free.begin(), free.end(), "gain") == free.end()) {
    throw InputError(model.where, 0, "the gain is fitted whenever the scale is",
                     "free gain, or both");
  }
}

void AddWarnings(const NoiseFieldFit& fit, double evolution, FitResult* result) {
  if (fit.status == NoiseFieldStatus::kAtEdge) {
    result->warnings.emplace_back(
        "the likelihood grows to the end of the scales that were tried: scale and gain are not "
        "determined");
  }
  if (fit.explained < kGoodShare) {
    result->warnings.push_back(fmt::format(
        "noise explains {:.0f} % of the velocities' mean square{}", 100 * fit.explained,
        evolution > 0 ? "" : "; if it changes with time, say so (--set evolution=SECONDS)"));
  }
  const double left_out =
      static_cast<double>(fit.left_out) / static_cast<double>(fit.left_out + fit.used);
  if (left_out > kManyLeftOut) {
    result->warnings.push_back(fmt::format(
        "{:.0f} % of the animals were left out, because something else moves them, and the gain "
        "may be too high: name walls (--walls) and the goal (--goal X,Y,Z,REACH)",
        100 * left_out));
  }
}

}  // namespace

bool DriftsFreely(const FitProblem& problem, double cell, const Vec3d& x) {
  if (problem.walls) {
    for (int axis = 0; axis < 3; ++axis) {
      if (AtAxis(x, axis) < AtAxis(problem.walls->low, axis) + cell ||
          AtAxis(x, axis) > AtAxis(problem.walls->high, axis) - cell) {
        return false;
      }
    }
  }
  if (problem.goal != GoalChoice::kGiven) return true;
  const double grid_cell = std::numbers::sqrt3 * cell;  // the way is interpolated within one
  return Norm(x - problem.goal_position) < problem.goal_reach - grid_cell;
}

VelocitySample DriftIn(const FitOptions& options, const FitProblem& problem, const ModelSpec& model,
                       const ObservedFlock& flock, int frame) {
  const double cell = model.parameters.at("cell");
  const double ahead = options.substeps > 0 ? 0.5 - 0.5 / options.substeps : 0.5;
  VelocitySample sample;
  for (int a = 0; a < flock.animals(); ++a) {
    if (!flock.Measured(a, frame) || !flock.Measured(a, frame + 1)) continue;
    const Vec3d& x = flock.Position(a, frame);
    const Vec3d step = flock.Position(a, frame + 1) - x;
    if (!DriftsFreely(problem, cell, x)) continue;
    sample.position.push_back(x + ahead * step);
    sample.velocity.push_back(step / flock.dt());
  }
  return sample;
}

std::vector<VelocitySample> DriftSamples(const FitOptions& options, const FitProblem& problem,
                                         const ModelSpec& model, const Trajectories& trajectories,
                                         double fps) {
  const ObservedFlock flock(trajectories, fps, 0);
  const double evolution = model.parameters.at("evolution");
  const auto drift = [&](int frame) { return DriftIn(options, problem, model, flock, frame); };
  const int first = flock.span().first, last = flock.span().last - 1;
  const auto wanted = static_cast<std::size_t>(options.noise_animals);
  std::vector<VelocitySample> samples;
  if (evolution > 0) {
    const int apart = std::max(1, static_cast<int>(std::ceil(2 * evolution * fps)));
    for (int f = first; f <= last && samples.size() < kMostSamples; f += apart) {
      samples.push_back(drift(f));
    }
  } else if (first <= last) {
    // As few frames as give enough, spread over the time.
    const int frames =
        std::clamp(static_cast<int>(wanted / std::max<std::size_t>(1, drift(first).size())), 1,
                   last - first + 1);
    samples.emplace_back();
    for (int k = 0; k < frames; ++k) {
      const VelocitySample one = drift(first + k * (last - first) / std::max(1, frames - 1));
      samples[0].position.insert(samples[0].position.end(), one.position.begin(),
                                 one.position.end());
      samples[0].velocity.insert(samples[0].velocity.end(), one.velocity.begin(),
                                 one.velocity.end());
    }
  }
  for (VelocitySample& sample : samples) sample = Thinned(sample, wanted);
  return samples;
}

FitResult FitSwarmNoise(const FitOptions& options, const FitProblem& problem,
                        const Trajectories& trajectories, double fps, int threads) {
  const ModelSpec model = CompleteModel(problem.model);
  const std::vector<std::string> free =
      problem.free.empty() ? std::vector<std::string>{"scale", "gain"} : problem.free;
  CheckProblem(problem, model, free);
  const bool with_scale = std::find(free.begin(), free.end(), "scale") != free.end();
  FitResult result;
  result.method = FitMethod::kNoiseField;
  result.parameters.model = model;
  result.parameters.walls = problem.walls;
  if (problem.goal == GoalChoice::kGiven) {
    GoalSpec goal;
    goal.position = problem.goal_position;
    goal.reach = problem.goal_reach;
    result.parameters.goals = {goal};
  }
  const FrameSpan span = SpanOf(trajectories);
  result.animals = static_cast<int>(trajectories.trajectories.size());
  result.frames = span.last - span.first + 1;
  const NoiseFieldFit fit =
      FitNoiseField({.scale = with_scale ? 0 : model.parameters.at("scale"), .threads = threads},
                    DriftSamples(options, problem, model, trajectories, fps));
  result.rows = static_cast<std::int64_t>(fit.used);
  if (fit.status == NoiseFieldStatus::kTooFew) {
    result.status = FitStatus::kTooFewAnimals;
    return result;
  }
  result.r2 = fit.explained;
  result.velocity_noise = fit.rest_sd;
  ParameterPosterior& posterior = result.parameters.posterior;
  const auto add = [&](const std::string& name, double value, double sd) {
    FittedWeight weight;
    weight.name = name;
    weight.value = weight.estimate = value;
    weight.sd = sd;
    weight.plain = std::nan("");
    weight.determined = fit.IsUsable() && 1.96 * sd < kKnown * value;
    result.weights.push_back(weight);
    result.parameters.model.parameters[name] = value;
    posterior.free.push_back(name);
    posterior.sd.push_back(sd);
    posterior.determined.push_back(weight.determined);
  };
  if (with_scale) add("scale", fit.scale, fit.scale_sd);
  add("gain", fit.gain, fit.gain_sd);
  posterior.correlation = {1};
  if (with_scale) posterior.correlation = {1, fit.correlation, fit.correlation, 1};
  AddWarnings(fit, model.parameters.at("evolution"), &result);
  return result;
}

}  // namespace flocklift::internal
