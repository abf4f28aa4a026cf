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
#include "reconstruct/fit/fitter.h"
#include "reconstruct/fit/held_out.h"
#include "reconstruct/fit/window_choice.h"
#include "simulate/flock/model.h"

namespace flocklift::internal {
namespace {

constexpr double kClearly = 0.9;                           // of E^2
constexpr double kLead = 1;                                // of the flights [s]
constexpr int kMostRows = 1500;                            // of each fit
constexpr double kRadii[] = {0.4, 0.55, 0.75, 1, 1.4, 2};  // of the model's d_s
constexpr double kRanges[] = {0.5, 0.7, 1.4, 2};           // of the model's d_v
constexpr double kEdges[] = {0, 0.5, 1};                   // of d_s, of the edge's width
constexpr double kBeside[] = {1.18, 1.09, 1.045};          // between a radius and the next, then
constexpr double kBesideEdge[] = {0.25, 0.12, 0.06};

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
    const FitResult fit = Fitter(quick_, problem, early_, fps_, seed_, threads_).Run({});
    // It need not be sought again; where it was not found, that may be the radii's fault.
    if (tried_.size() == 1 && problem_.goal == GoalChoice::kWhenHeld) {
      goal_ = fit.parameters.goals.empty() ? Middle(early_) : fit.parameters.goals[0].position;
    }
    return found->second = ErrorOf(fit);
  }
  // E^2 of a fit as the problem asks for it, by all rows.
  double CheckedError(const Radii& radii, GoalChoice goal) const {
    FitProblem problem = ProblemWith(radii);
    problem.goal = goal;
    return ErrorOf(Fitter(options_, problem, early_, fps_, seed_, threads_).Run({}));
  }
  void Try(const Radii& radii) {
    if (Error(radii) < Error(best_)) best_ = radii;
  }

  Radii Run(const Radii& start) {
    best_ = start;
    Error(start);
    for (const double radius : kRadii) {
      for (const double share : kEdges) {
        Try({radius * start.d_s, start.d_v, share});
      }
    }
    for (const double range : kRanges) {
      Try({best_.d_s, range * start.d_v, best_.edge});
    }
    for (std::size_t k = 0; k < std::size(kBeside); ++k) {
      for (const double step : {-kBesideEdge[k], kBesideEdge[k]}) {
        Try({best_.d_s, best_.d_v, std::max(0.0, best_.edge + step)});
      }
      for (const double step : {1 / kBeside[k], kBeside[k]}) {
        Try({step * best_.d_s, best_.d_v, best_.edge});
        Try({best_.d_s, step * best_.d_v, best_.edge});
      }
    }
    return best_;
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

FitProblem ChooseRadii(const FitOptions& options, const FitProblem& problem,
                       const Trajectories& trajectories, double fps, std::uint64_t seed,
                       int threads, std::vector<std::string>* notes) {
  const ModelSpec complete = CompleteModel(problem.model);
  const auto& defaults = complete.parameters;
  if (!defaults.contains("d_s") || !defaults.contains("d_v") || !defaults.contains("taper") ||
      !(defaults.at("d_s") > 0)) {
    return problem;
  }
  Choice choice(options, problem, trajectories, fps, seed, threads);
  for (const char* name : {"d_s", "d_v", "taper"}) {
    if (!choice.IsOpen(name)) return problem;  // somebody knows
  }
  const double d_s = defaults.at("d_s");
  const Radii start{d_s, defaults.at("d_v"), defaults.at("taper") / d_s};
  const Radii best = choice.Run(start);
  if (!(choice.Error(best) < kClearly * choice.Error(start))) return problem;
  const double by_model = choice.CheckedError(start, problem.goal);
  double by_choice = choice.CheckedError(best, problem.goal);
  FitProblem better = problem;
  if (problem.goal == GoalChoice::kWhenHeld && !(by_choice < kClearly * by_model)) {
    better.goal = GoalChoice::kSought;  // the quick fits had one
    by_choice = choice.CheckedError(best, better.goal);
  }
  if (!(by_choice < kClearly * by_model)) return problem;
  better.model = choice.With(best);
  const ModelSpec& chosen = better.model;
  for (const char* name : {"d_s", "d_v", "taper"}) {
    if (chosen.parameters.at(name) == defaults.at(name)) continue;
    notes->push_back(
        fmt::format("{} is {:.3g} instead of the model's {:.3g}: so the motion is "
                    "foreseen best",
                    name, chosen.parameters.at(name), defaults.at(name)));
  }
  return better;
}

}  // namespace flocklift::internal
