// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/replay/guided_flight.h"

#include <utility>
#include <variant>

#include "reconstruct/fit/scene_terms.h"
#include "simulate/core/check.h"
#include "simulate/flock/integrator.h"
#include "simulate/flock/model.h"

namespace flocklift {
namespace {

// Rate at which a model's animals return to their own speed [1/s]; 0 in models without one.
double CruiseRate(const ModelSpec& model) {
  const ModelParameters parameters = ResolveModel(model);
  const auto* boids = std::get_if<BoidsParameters<double>>(&parameters);
  const double own = boids == nullptr ? 0 : InSeconds(*boids).cruise;
  return own + CruiseRateOfTerms(model);
}

std::optional<GoalSpec> FirstGoal(const Parameters& parameters) {
  if (parameters.goals.empty()) return std::nullopt;
  return parameters.goals.front();
}

}  // namespace

GuidedFlight::GuidedFlight(const Parameters& parameters, double alpha, double pull_time,
                           std::vector<Vec3d> position, std::vector<Vec3d> velocity,
                           std::vector<double> cruising_speed, const TermSurroundings& around)
    : terms_(
          MakeFlockTerms(parameters.model, {}, parameters.walls, FirstGoal(parameters), 0, around)),
      alpha_(alpha),
      pull_time_(pull_time),
      cruise_(CruiseRate(parameters.model)),
      position_(std::move(position)),
      velocity_(std::move(velocity)),
      cruising_speed_(std::move(cruising_speed)),
      accelerations_(position_.size() * terms_.columns()) {
  Check(velocity_.size() == position_.size() && cruising_speed_.size() == position_.size(),
        "a guided flight needs a velocity and a cruising speed for each animal");
  Check(alpha >= 0 && alpha <= 1, "alpha must be in 0 to 1");
  Check(pull_time > 0, "the pull's time must be positive");
}

void GuidedFlight::Step(const std::vector<std::optional<PathPoint>>& paths, double dt) {
  terms_.evaluate(position_, velocity_, accelerations_);
  const SpeedLimit::Params<double> limit{terms_.min_speed, terms_.max_speed, 0.0};
  const double w = 1 / pull_time_;
  for (std::size_t k = 0; k < position_.size(); ++k) {
    Vec3d a = accelerations_[2 * k];
    if (terms_.has_own_speed) a += (cruise_ * cruising_speed_[k]) * accelerations_[2 * k + 1];
    if (paths[k]) {
      const Vec3d pull = (w * w) * (paths[k]->position - position_[k]) +
                         (2 * w) * (paths[k]->velocity - velocity_[k]);
      a = alpha_ * a + (1 - alpha_) * pull;
    }
    Advance(a, dt, limit, &position_[k], &velocity_[k]);
  }
}

}  // namespace flocklift
