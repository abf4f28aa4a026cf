// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/fit_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "reconstruct/fit/departure.h"
#include "reconstruct/fit/fit_scene.h"
#include "reconstruct/fit/kernel_prediction.h"
#include "reconstruct/fit/simulated_prediction.h"
#include "simulate/core/check.h"
#include "simulate/flock/model.h"

namespace flocklift {
namespace {

constexpr const char* kConstantVelocity = "constant velocity";

ModelScore ScoreModel(const FitOptions& options, const FitProblem& problem, const std::string& name,
                      const Trajectories& trajectories, double fps, std::uint64_t seed,
                      int threads) {
  FitProblem other = problem;
  if (name != problem.model.name) {
    if (problem.scene && !other.walls) other.walls = problem.scene->box;
    other.scene.reset();
    other.model = ModelSpec{.name = name, .parameters = {}, .where = "--compare", .where_of = {}};
    other.free.clear();
  }
  if (!internal::WhyNotRegressed(other).empty()) {
    other.method = FitMethod::kAuto;
    const SimulatedPrediction flown =
        PredictBySimulation(options, other, trajectories, fps, seed, threads);
    ModelScore score{
        .model = name, .weights = flown.fit.weights.size(), .r2_held_out = flown.r2, .fault = {}};
    if (!flown.fit.IsUsable()) score.fault = StatusText(flown.fit.status);
    return score;
  }
  other.method = FitMethod::kErrorsInVariables;
  other.free.clear();
  const FitResult result = FitModel(options, other, trajectories, fps, seed, threads);
  ModelScore score{.model = name,
                   .weights = result.weights.size(),
                   .r2_held_out = result.r2_held_out,
                   .fault = {}};
  if (!result.IsUsable()) score.fault = StatusText(result.status);
  return score;
}

ModelScore ScoreKernels(const FitOptions& options, const KernelFitOptions& kernels,
                        const std::vector<Trajectories>& flocks, double fps, std::uint64_t seed,
                        int threads) {
  const KernelPrediction prediction =
      PredictWithKernels(options, kernels, flocks, fps, seed, threads);
  ModelScore score{.model = kKernelsModel,
                   .weights = static_cast<std::size_t>(std::lround(prediction.fit.effective)),
                   .r2_held_out = prediction.r2,
                   .fault = {}};
  if (!prediction.fit.IsUsable()) score.fault = StatusText(prediction.fit.status);
  return score;
}

}  // namespace

void CheckComparable(const std::vector<std::string>& models, const std::string& in_scene) {
  for (const std::string& name : models) {
    if (name == kKernelsModel) continue;
    const ModelSpec model{.name = name, .parameters = {}, .where = "--compare", .where_of = {}};
    CompleteModel(model);
    const std::string why = name == in_scene ? "" : WhyNoDeparture(model);
    if (why.empty()) continue;
    throw InputError("--compare", 0, "model " + name + " cannot be flown from trajectories: " + why,
                     "leave it out, or give its scene: --scene SCENE.toml --model " + name);
  }
}

std::vector<ModelScore> CompareModels(const FitOptions& options, const FitProblem& problem,
                                      const KernelFitOptions& kernels,
                                      const std::vector<std::string>& models,
                                      const std::vector<Trajectories>& flocks, double fps,
                                      std::uint64_t seed, int threads) {
  if (models.empty()) return {};
  CheckComparable(models, problem.scene ? problem.model.name : "");
  std::vector<ModelScore> scores;
  scores.push_back({.model = kConstantVelocity, .weights = 0, .r2_held_out = 0.0, .fault = {}});
  FitOptions quick = options;
  quick.depth_draws = 0;
  if (quick.held_out == 0) quick.held_out = FitOptions().held_out;
  for (const std::string& name : models) {
    scores.push_back(name == kKernelsModel
                         ? ScoreKernels(quick, kernels, flocks, fps, seed, threads)
                         : ScoreModel(quick, problem, name, flocks.at(0), fps, seed, threads));
  }
  const auto value = [](const ModelScore& score) {
    return score.r2_held_out.value_or(-std::numeric_limits<double>::infinity());
  };
  std::stable_sort(scores.begin(), scores.end(),
                   [&](const ModelScore& a, const ModelScore& b) { return value(a) > value(b); });
  return scores;
}

nlohmann::ordered_json ScoresAsJson(const std::vector<ModelScore>& scores) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const ModelScore& score : scores) {
    json.push_back({{"model", score.model}, {"weights", score.weights}});
    json.back()["r2_held_out"] =
        score.r2_held_out ? nlohmann::ordered_json(*score.r2_held_out) : nlohmann::ordered_json();
    if (!score.fault.empty()) json.back()["fault"] = score.fault;
  }
  return json;
}

void PrintScores(const std::vector<ModelScore>& scores) {
  fmt::print(stderr, "  {:<18} {:>8} {:>12}\n", "model", "weights", "held-out R^2");
  for (const ModelScore& score : scores) {
    fmt::print(stderr, "  {:<18} {:>8} {:>12}\n", score.model, score.weights,
               score.r2_held_out ? fmt::format("{:.4f}", *score.r2_held_out) : score.fault);
  }
}

}  // namespace flocklift
