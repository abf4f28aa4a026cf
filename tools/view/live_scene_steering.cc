// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What somebody who looks does to a running scene: parameters, goals, predators, wind and paths.

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/flock/model.h"
#include "simulate/shapes/spline_path.h"
#include "tools/view/live_scene.h"
#include "tools/view/sketch.h"

namespace flocklift {
namespace {

constexpr int kWaypoints = 24;
constexpr int kPointsOfPath = 12;

void CheckFinite(const Vec3d& v) {
  constexpr double kFarthest = 1e7;  // [m]
  Check(std::isfinite(SquaredNorm(v)) && Norm(v) < kFarthest, "a place must be finite and near");
}

// Puts the spec's settings into another's.
void Merge(const ModelSpec& change, ModelSpec* spec) {
  for (const auto& [name, value] : change.parameters) spec->parameters[name] = value;
  for (const auto& [name, word] : change.choices) spec->choices[name] = word;
}

bool IsModel(const Scene& scene, std::string_view name) {
  return std::any_of(scene.species.begin(), scene.species.end(),
                     [&](const SpeciesSpec& s) { return s.model.name == name; });
}

}  // namespace

void LiveScene::SetParameter(const std::string& species, const ModelSpec& change) {
  Do([&] {
    for (SpeciesSpec& spec : scene_.species) {
      if (spec.name != species) continue;
      ModelSpec merged = spec.model;
      Merge(change, &merged);
      ResolveModel(merged);  // throws before anything changed
      engine_->SetParameters(species, change);
      spec.model = merged;
      return;
    }
    Check(false, "there is no species " + species);
  });
}

void LiveScene::MoveGoal(std::size_t index, const Vec3d& position) {
  CheckFinite(position);
  Do([&] {
    Check(index < scene_.goals.size(), "there is no such goal");
    engine_->MoveGoal(index, position);
    scene_.goals[index].position = position;
    scene_.goals[index].waypoints.clear();
  });
}

void LiveScene::MovePredator(std::size_t index, const Vec3d& position) {
  CheckFinite(position);
  Do([&] {
    std::size_t predators = 0;
    for (const PredatorSpec& spec : scene_.predators) {
      predators += static_cast<std::size_t>(spec.count);
    }
    Check(index < predators, "there is no such predator");
    engine_->MovePredator(index, position);
  });
}

void LiveScene::SetWind(const Vec3d& velocity) {
  CheckFinite(velocity);
  Do([&] {
    engine_->SetWind(velocity);
    scene_.wind.velocity = velocity;
  });
}

void LiveScene::Attract(const std::optional<Vec3d>& position, double weight) {
  if (position) CheckFinite(*position);
  Check(weight > 0 && weight <= 1000, "the weight must be positive");
  const std::vector<SpeciesSpec> species = Current().species;
  const bool follows = std::any_of(species.begin(), species.end(), [](const SpeciesSpec& one) {
    return one.model.name != "morph";
  });
  Check(!position || follows,
        "the model morph goes to shapes, not to goals: draw its path instead");
  Do([&] {
    const bool crowd = IsModel(scene_, "crowd");
    if (crowd && scene_.goals.empty()) return;
    if (crowd || (IsModel(scene_, "swarm") && !scene_.goals.empty() && !attraction_)) {
      if (!position) return;
      GoalSpec& goal = scene_.goals[0];
      goal.position = *position;
      if (std::exchange(goal.waypoints, {}).empty()) return engine_->MoveGoal(0, *position);
      return Rebuild();
    }
    const std::vector<GoalSpec> before = scene_.goals;
    const auto attraction_before = attraction_;
    if (position && attraction_ && scene_.goals[*attraction_].weight == weight &&
        scene_.goals[*attraction_].waypoints.empty()) {
      engine_->MoveGoal(*attraction_, *position);
      scene_.goals[*attraction_].position = *position;
      return;
    }
    if (attraction_) {
      scene_.goals.erase(scene_.goals.begin() + static_cast<std::ptrdiff_t>(*attraction_));
      attraction_.reset();
    }
    if (position) {
      attraction_ = scene_.goals.size();
      scene_.goals.push_back({.species = {}, .position = *position, .weight = weight});
    }
    try {
      Rebuild();
    } catch (...) {
      scene_.goals = before;
      attraction_ = attraction_before;
      throw;
    }
  });
}

void LiveScene::Lead(const std::vector<Vec3d>& line, double seconds, double weight) {
  Check(line.size() >= 2, "a way needs two points");
  Check(seconds > 0 && seconds < 1e5 && weight > 0, "a way needs a time and a weight");
  for (const Vec3d& p : line) CheckFinite(p);
  Check(!IsModel(Current(), "crowd"), "the model crowd cannot be led along a line");
  Attract(line.front(), weight);
  Do([&] {
    GoalSpec& goal = scene_.goals.at(attraction_.value_or(0));
    const std::vector<Vec3d> points = EvenlyAlong(line, kWaypoints);
    for (int k = 0; k < kWaypoints; ++k) {
      goal.waypoints.push_back({.time = engine_->time() + seconds * k / (kWaypoints - 1),
                                .position = points[static_cast<std::size_t>(k)]});
    }
    Rebuild();
  });
}

void LiveScene::Guide(const std::vector<Vec3d>& line) {
  Check(line.size() >= 2, "a path needs two points");
  for (const Vec3d& p : line) CheckFinite(p);
  Do([&] {
    Check(!scene_.paths.empty(), "the scene has no path");
    const auto from_line = [&](const PathSpec& path) {
      return Norm(path.points.front() - line.front());
    };
    PathSpec& path = *std::min_element(
        scene_.paths.begin(), scene_.paths.end(),
        [&](const PathSpec& a, const PathSpec& b) { return from_line(a) < from_line(b); });
    const std::vector<Vec3d> points = EvenlyAlong(line, kPointsOfPath);
    SplinePath(points, /*closed=*/false);  // throws, when it is none
    const std::vector<Vec3d> before = std::exchange(path.points, points);
    try {
      Restart();
    } catch (...) {
      path.points = before;
      throw;
    }
  });
}

}  // namespace flocklift
