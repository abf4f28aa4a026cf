// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/fit_scene.h"

#include <algorithm>
#include <cmath>

#include "reconstruct/fit/engine_flight.h"
#include "reconstruct/fit/flock_terms.h"
#include "reconstruct/fit/process_model.h"
#include "reconstruct/fit/scene_terms.h"
#include "reconstruct/fit/statistics_fit.h"
#include "simulate/core/check.h"
#include "simulate/core/model_terms.h"
#include "simulate/core/suggest.h"
#include "simulate/flock/model.h"

namespace flocklift::internal {
namespace {

bool HasTerm(const ModelSpec& model, const std::string& type) {
  return std::any_of(model.terms.begin(), model.terms.end(),
                     [&](const ModelSpec& term) { return term.name == type; });
}

bool Moves(const GoalSpec& goal) { return goal.period > 0 || goal.waypoints.size() > 1; }

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

FitProblem InScene(FitProblem problem) {
  if (problem.model.name == "forces" && problem.model.terms.empty()) {
    throw InputError(problem.model.where, 0, "model forces has no force but those of a scene",
                     "give the scene that has them: --scene SCENE.toml");
  }
  if (!problem.model.terms.empty()) {
    const ModelSpec complete = CompleteModel(problem.model);
    for (const std::string& name : problem.free) {
      if (FindNumber(complete, name) != nullptr) continue;
      throw InputError("--free", 0,
                       "model " + problem.model.name + " has no number `" + name + "` to be fitted",
                       SuggestName(name, NumberNames(complete)));
    }
  }
  if (!problem.scene) return problem;
  SpeciesOf(*problem.scene, problem.model.name);  // or throws
  if (!problem.walls) problem.walls = problem.scene->box;
  return problem;
}

FitOptions InScene(FitOptions options, const FitProblem& problem, double fps) {
  if (!problem.scene) return options;
  const double steps = problem.scene->fps * problem.scene->substeps / fps;
  options.substeps = std::clamp(static_cast<int>(std::lround(steps)), 1, 1000);
  return options;
}

TermSurroundings SurroundingsOf(const FitProblem& problem) {
  TermSurroundings around{.walls = problem.walls};
  if (problem.scene) {
    const std::string& species = SpeciesOf(*problem.scene, problem.model.name).name;
    for (GoalSpec goal : problem.scene->goals) {
      if (!goal.species.empty() && goal.species != species) continue;
      if (goal.waypoints.size() == 1) goal.position = goal.waypoints[0].position;
      around.goals.push_back(goal);
    }
    around.wind = problem.scene->wind.velocity;
    around.flat = problem.scene->dimensions == 2;
  }
  if (problem.goal == GoalChoice::kGiven) {
    GoalSpec goal;
    goal.position = problem.goal_position;
    around.goals = {goal};
  }
  return around;
}

std::string WhyNotRegressed(const FitProblem& problem) {
  const ModelSpec& model = problem.model;
  if (LinearWeights(model).empty()) return "it has no terms that a fit could weigh";
  if (const std::string why = UnknownTerm(model); !why.empty()) return why;
  if (!problem.scene) return "";
  const std::vector<GoalSpec> goals = SurroundingsOf(problem).goals;
  if (HasTerm(model, "goal") && std::any_of(goals.begin(), goals.end(), Moves)) {
    return "the goals that pull move";
  }
  if (HasTerm(model, "wind") && problem.scene->wind.gust > 0) return "the wind has gusts";
  if (!problem.scene->events.empty()) return "events change what moves it";
  return "";
}

bool ByStatistics(const FitProblem& problem) {
  if (problem.method != FitMethod::kAuto) return problem.method == FitMethod::kStatistics;
  if (KnownByStatistics(problem.model.name)) return true;
  if (problem.model.name == "swarm" || (!problem.scene && problem.model.terms.empty())) {
    return false;
  }
  if (!WhyNotRegressed(problem).empty()) return true;
  const ModelSpec complete = CompleteModel(problem.model);
  std::vector<std::string> known = LinearWeights(complete);
  for (const std::string& name : SmoothParameters(complete)) known.push_back(name);
  return std::any_of(problem.free.begin(), problem.free.end(), [&](const std::string& name) {
    return FindNumber(complete, name) != nullptr && !Contains(known, name);
  });
}

}  // namespace flocklift::internal
