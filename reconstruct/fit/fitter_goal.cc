// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/fitter.h"

#include <algorithm>
#include <cmath>

#include "reconstruct/fit/fit_measures.h"
#include "reconstruct/fit/fit_setup.h"
#include "simulate/core/vec3.h"

namespace flocklift::internal {
namespace {

constexpr double kConfining = 0.05;       // share of u pulling to the middle that calls for a goal
constexpr int kGoalRounds = 8;            // of moving it
constexpr double kGoalTolerance = 0.03;   // ... until it moves by less, of its range
constexpr std::size_t kFrameEffects = 5;  // animals a frame that frame effects need

}  // namespace

void Fitter::UseGoal(const std::optional<GoalSpec>& goal) {
  goal_ = goal;
  std::vector<std::string> names(free_.begin(),
                                 free_.begin() + static_cast<std::ptrdiff_t>(weights_));
  if (goal) names.push_back(kGoalWeight);
  // A goal that moves pushes all animals alike by its motion; what their cruising speeds have in
  // common is then taken from their speeds.
  whitening_.frame_effects =
      goal.has_value() && rows_.size() >= kFrameEffects * static_cast<std::size_t>(result_.frames);
  cruising_speed_ = whitening_.frame_effects ? MeanSpeed(flock_) : 0;
  terms_ = MakeFlockTerms(model_, names, problem_.walls, goal, cruising_speed_, around_);
}

// Weights without what holds the animals may pass it for noise that lasts, so that nothing is left
// over that would call for a goal: their accelerations are asked too.
bool Fitter::IsHeld() const {
  if (problem_.walls) return false;
  return std::max(Pull(), PullToTheMiddle(rows_, rows_.response)) > kConfining;
}

void Fitter::SettleGoal(WhitenedFit* fit) {
  const bool possible = model_.parameters.contains("goal_range");
  if (!possible || problem_.goal == GoalChoice::kNone) return;
  const bool may_go_without = problem_.goal == GoalChoice::kWhenHeld;
  if (may_go_without && !IsHeld()) return;
  const std::optional<double> without = Prediction();
  Vec3d mean;
  for (const Vec3d& x : rows_.position) mean += x / static_cast<double>(rows_.size());
  GoalSpec goal;
  goal.position = problem_.goal == GoalChoice::kGiven ? problem_.goal_position : mean;
  LocateGoal(goal, fit);
  if (!may_go_without || (fit->IsUsable() && Prediction() > without)) return;
  UseGoal({});
  *fit = Solve({});
}

void Fitter::LocateGoal(GoalSpec goal, WhitenedFit* fit) {
  const double range = model_.parameters.at("goal_range");
  for (int round = 0; round < kGoalRounds; ++round) {
    UseGoal(goal);
    *fit = Solve({});
    if (!fit->IsUsable() || problem_.goal == GoalChoice::kGiven) return;
    const double weight = fit->regression.estimate.back();
    if (!(weight > 0)) return;
    Vec3d left;
    double slope = 0;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      left += u_[k];
      const double far = SquaredNorm(rows_.position[k] - goal.position) / (range * range);
      slope += weight / std::sqrt(1 + far);
    }
    const Vec3d step = left / slope;
    if (Norm(step) < kGoalTolerance * range) return;
    goal.position += std::min(1.0, range / Norm(step)) * step;
  }
}

}  // namespace flocklift::internal
