// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/radius_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>

#include "reconstruct/fit/fit_scene.h"
#include "reconstruct/fit/held_out.h"
#include "reconstruct/fit/window_choice.h"
#include "simulate/flock/model.h"

namespace flocklift::internal {
namespace {

constexpr double kClearly = 0.9;  // of E^2
constexpr double kLead = 1;       // of the flights [s]
constexpr int kMostRows = 1500;   // of each fit
constexpr double kRadii[] = {0.4, 0.47, 0.55, 0.64, 0.75, 0.87, 1, 1.2, 1.4, 1.7, 2};  // of d_s
constexpr double kRanges[] = {0.5, 0.7, 1.4, 2};          // of the model's d_v
constexpr double kEdges[] = {0, 0.5, 1};                  // of d_s, of the edge's width
constexpr double kBeside[] = {1.18, 1.09, 1.045, 1.022};  // between a radius and the next, then
constexpr double kBesideEdge[] = {0.25, 0.12, 0.06, 0.03};
constexpr std::size_t kChecked[] = {1, 2};  // of these, with the fit that is asked for

struct Radii {
  double d_s = 0, d_v = 0, edge = 0;  // the edge as a share of d_s

  auto operator<=>(const Radii&) const = default;
};

Vec3d Middle(const Trajectories& flock) {
  Vec3d sum;
  double count = 0;
  for (const Trajectory& path : flock.trajectories) {
    for (const TrajectoryPoint& point : path.points) {
      sum += point.position;
      count += 1;
    }
  }
  return sum / std::max(count, 1.0);
}

// Each a step beside what `middle` is when its turn comes.
template <typename TryOne>
void TryBeside(std::size_t level, const Radii& middle, const TryOne& try_one) {
  for (const double step : {-kBesideEdge[level], kBesideEdge[level]}) {
    try_one({middle.d_s, middle.d_v, std::max(0.0, middle.edge + step)});
  }
  for (const double step : {1 / kBeside[level], kBeside[level]}) {
    try_one({step * middle.d_s, middle.d_v, middle.edge});
    try_one({middle.d_s, step * middle.d_v, middle.edge});
  }
}

class Choice {
 public:
  Choice(const FitOptions& options, const FitProblem& problem, const Trajectories& trajectories,
         double fps, std::uint64_t seed, int threads)
      : options_(options),
        problem_(problem),
        early_(BeforeFrame(trajectories, FirstHeldOut(trajectories, options.held_out))),
        fps_(fps),
        seed_(seed),
        threads_(threads),
        around_(SurroundingsOf(problem)) {
    options_.held_out = 0;
    options_.depth_draws = 0;
    quick_ = options_;
    quick_.substeps = 1;
    quick_.max_rows = std::min(options_.max_rows, kMostRows);
  }

  bool IsOpen(const char* name) const {
    return !problem_.model.parameters.contains(name) &&
           std::find(problem_.free.begin(), problem_.free.end(), name) == problem_.free.end();
  }

  // E^2.
  double Error(const Radii& radii) {
    const auto [found, is_new] = tried_.try_emplace(radii, 0);
    if (!is_new) return found->second;
    FitProblem problem = ProblemWith(radii);
    if (goal_) {
      problem.goal = GoalChoice::kGiven;
      problem.goal_position = *goal_;
    }
    const FitResult fit = Run(quick_, problem, NoiseAssumed::kIsSmall);
    // It need not be sought again; where it was not found, that may be the radii's fault.
    if (tried_.size() == 1 && problem_.goal == GoalChoice::kWhenHeld) {
      goal_ = fit.parameters.goals.empty() ? Middle(early_) : fit.parameters.goals[0].position;
    }
    return found->second = ErrorOf(fit);
  }
  FitResult Run(const FitOptions& options, const FitProblem& problem, NoiseAssumed noise) const {
    Fitter fitter(options, problem, early_, fps_, seed_, threads_);
    fitter.Assume(noise);
    return fitter.Run({});
  }
  // E^2 of a fit as the problem asks for it, by all rows.
  double CheckedError(const Radii& radii, GoalChoice goal, NoiseAssumed noise) const {
    FitProblem problem = ProblemWith(radii);
    problem.goal = goal;
    return ErrorOf(Run(options_, problem, noise));
  }
  void Try(const Radii& radii) {
    if (Error(radii) < Error(best_)) best_ = radii;
  }

  // The best found from each width of the edge: narrow ones ask for exact radii, and are missed
  // beside the best of wide ones.
  std::vector<Radii> Run(const Radii& start) {
    Error(start);
    std::vector<Radii> found;
    for (const double share : kEdges) {
      best_ = {start.d_s, start.d_v, share};
      for (const double radius : kRadii) Try({radius * start.d_s, start.d_v, share});
      for (const double range : kRanges) Try({best_.d_s, range * start.d_v, share});
      for (std::size_t k = 0; k < std::size(kBeside); ++k) {
        TryBeside(k, best_, [this](const Radii& radii) { Try(radii); });
      }
      if (std::find(found.begin(), found.end(), best_) == found.end()) found.push_back(best_);
    }
    return found;
  }

  ModelSpec With(const Radii& radii) const {
    ModelSpec model = problem_.model;
    model.parameters["d_s"] = radii.d_s;
    model.parameters["d_v"] = radii.d_v;
    model.parameters["taper"] = radii.edge * radii.d_s;
    return model;
  }

 private:
  FitProblem ProblemWith(const Radii& radii) const {
    FitProblem problem = problem_;
    problem.model = With(radii);
    problem.method = FitMethod::kErrorsInVariables;
    return problem;
  }
  double ErrorOf(const FitResult& fit) const {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    if (!fit.IsUsable() || fit.method != FitMethod::kErrorsInVariables) return kNone;
    try {
      const double flown =
          FlyOn(fit.parameters, early_, fps_, options_.substeps, kLead, around_).model;
      return std::isfinite(flown) ? flown * flown : kNone;
    } catch (const std::runtime_error&) {
      return kNone;  // it flew apart
    }
  }

  FitOptions options_, quick_;
  const FitProblem& problem_;
  const Trajectories early_;
  double fps_;
  std::uint64_t seed_;
  int threads_;
  TermSurroundings around_;
  std::optional<Vec3d> goal_;
  Radii best_;
  std::map<Radii, double> tried_;
};

}  // namespace

RadiusChoice ChooseRadii(const FitOptions& options, const FitProblem& problem,
                         const Trajectories& trajectories, double fps, std::uint64_t seed,
                         int threads) {
  RadiusChoice chosen{.problem = problem, .notes = {}};
  const ModelSpec complete = CompleteModel(problem.model);
  const auto& defaults = complete.parameters;
  if (!defaults.contains("d_s") || !defaults.contains("d_v") || !defaults.contains("taper") ||
      !(defaults.at("d_s") > 0)) {
    return chosen;
  }
  Choice choice(options, problem, trajectories, fps, seed, threads);
  for (const char* name : {"d_s", "d_v", "taper"}) {
    if (!choice.IsOpen(name)) return chosen;  // somebody knows
  }
  const double d_s = defaults.at("d_s");
  const Radii start{d_s, defaults.at("d_v"), defaults.at("taper") / d_s};
  const std::vector<Radii> found = choice.Run(start);
  const double by_model = choice.CheckedError(start, problem.goal, NoiseAssumed::kMayLast);
  double least = kClearly * by_model;
  std::optional<Radii> best;
  const auto check = [&](const Radii& radii, GoalChoice goal, NoiseAssumed noise) {
    const double error = choice.CheckedError(radii, goal, noise);
    if (!(error < least)) return;
    least = error;
    best = radii;
    chosen.problem.goal = goal;
    chosen.noise = noise;
  };
  constexpr NoiseAssumed kEither[] = {NoiseAssumed::kMayLast, NoiseAssumed::kIsNew};
  // The quick fits had a goal.
  for (const GoalChoice goal : {problem.goal, GoalChoice::kSought}) {
    for (const Radii& radii : found) {
      for (const NoiseAssumed noise : kEither) check(radii, goal, noise);
    }
    if (best || problem.goal != GoalChoice::kWhenHeld) break;
  }
  if (!best) return chosen;
  for (const std::size_t level : kChecked) {
    TryBeside(level, *best, [&](const Radii& radii) {
      for (const NoiseAssumed noise : kEither) check(radii, chosen.problem.goal, noise);
    });
  }
  chosen.problem.model = choice.With(*best);
  for (const char* name : {"d_s", "d_v", "taper"}) {
    const double value = chosen.problem.model.parameters.at(name);
    if (value == defaults.at(name)) continue;
    chosen.notes.push_back(
        fmt::format("{} is {:.3g} instead of the model's {:.3g}: so the motion is "
                    "foreseen best",
                    name, value, defaults.at(name)));
  }
  if (chosen.noise == NoiseAssumed::kIsNew) {
    chosen.notes.emplace_back(
        "what the model leaves over counts as new in every frame: so the motion is foreseen best");
  }
  return chosen;
}

}  // namespace flocklift::internal
