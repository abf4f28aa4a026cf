// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/fit_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

namespace flocklift {
namespace {

nlohmann::ordered_json NumberOrNull(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

nlohmann::ordered_json WeightAsJson(const FittedWeight& weight) {
  const double value = weight.determined ? weight.value : std::nan("");
  nlohmann::ordered_json json = {{"name", weight.name},
                                 {"value", NumberOrNull(value)},
                                 {"flown", weight.value},
                                 {"estimate", NumberOrNull(weight.estimate)},
                                 {"sd", NumberOrNull(weight.sd)},
                                 {"determined", weight.determined},
                                 {"plain_least_squares", NumberOrNull(weight.plain)}};
  if (weight.depth_factor) json["depth_error_factor"] = NumberOrNull(*weight.depth_factor);
  if (weight.depth_share) json["depth_error_share"] = *weight.depth_share;
  if (weight.depth_factor_sd) json["depth_error_factor_sd"] = NumberOrNull(*weight.depth_factor_sd);
  return json;
}

nlohmann::ordered_json DirectionAsJson(const FitResult& result, const FitDirection& direction) {
  nlohmann::ordered_json weights = nlohmann::ordered_json::object();
  for (std::size_t k = 0; k < direction.weights.size(); ++k) {
    weights[result.weights[k].name] = direction.weights[k];
  }
  return {{"sd", NumberOrNull(direction.sd)}, {"weights", weights}};
}

}  // namespace

nlohmann::ordered_json FitFigures(const FitResult& result) {
  nlohmann::ordered_json json = {{"method", NameOf(result.method)},
                                 {"animals", result.animals},
                                 {"frames", result.frames},
                                 {"rows", result.rows}};
  for (const auto& [name, misfit] : result.misfit) json["misfit"][name] = misfit;
  if (result.velocity_noise) json["velocity_noise"] = *result.velocity_noise;
  if (result.method == FitMethod::kNoiseField) json["r2"] = result.r2;
  if (result.method == FitMethod::kStatistics) json["own_speed_mean"] = result.own_speed_mean;
  const bool accelerates =
      result.method != FitMethod::kNoiseField && result.method != FitMethod::kStatistics;
  if (accelerates) {
    json.update({{"rows_clamped", result.rows_clamped},
                 {"rows_mixed", result.rows_mixed},
                 {"window", result.window},
                 {"acceleration_sd", result.acceleration_sd},
                 {"residual_sd", result.residual_sd},
                 {"r2", result.r2},
                 {"noise_sd", NumberOrNull(result.noise_sd)},
                 {"noise_time", NumberOrNull(result.noise_time)},
                 {"diffusion", NumberOrNull(result.diffusion)},
                 {"own_speed_mean", result.own_speed_mean},
                 {"own_speed_sd", result.own_speed_sd},
                 {"condition", NumberOrNull(result.condition)}});
  }
  if (result.diffusion_sd) json["diffusion_sd"] = *result.diffusion_sd;
  if (result.position_noise) json["position_noise"] = *result.position_noise;
  if (result.r2_held_out) json["r2_held_out"] = *result.r2_held_out;
  for (const GoalSpec& goal : result.parameters.goals) {
    json["goal"] = {goal.position.x, goal.position.y, goal.position.z};
  }
  for (const FittedWeight& weight : result.weights) {
    json["weights"].push_back(WeightAsJson(weight));
  }
  for (const HeldTest& held : result.held) {
    json["held"].push_back({{"name", held.name}, {"value", held.value}, {"z", held.z}});
  }
  json["correlation"] = result.parameters.posterior.correlation;
  if (!accelerates) return json;
  json["best_direction"] = DirectionAsJson(result, result.best);
  json["worst_direction"] = DirectionAsJson(result, result.worst);
  return json;
}

void PrintFit(const FitResult& result) {
  std::size_t width = 12;
  for (const FittedWeight& weight : result.weights) width = std::max(width, weight.name.size());
  fmt::print(stderr, "  {:<{}} {:>10} {:>10}   {:>13}\n", "weight", width, "value", "sd",
             "differences");
  for (const FittedWeight& weight : result.weights) {
    const std::string plain =
        std::isfinite(weight.plain) ? fmt::format("{:.4g}", weight.plain) : "";
    if (weight.determined) {
      fmt::print(stderr, "  {:<{}} {:>10.4g} {:>10.2g}   {:>13}\n", weight.name, width,
                 weight.value, weight.sd, plain);
    } else {
      fmt::print(stderr, "  {:<{}} {:>10} {:>10.2g}   {:>13}\n", weight.name, width, "unknown",
                 weight.sd, plain);
    }
  }
}

}  // namespace flocklift
