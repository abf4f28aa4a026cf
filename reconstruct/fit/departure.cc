// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/departure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "reconstruct/fit/engine_flight.h"
#include "reconstruct/fit/goal_groups.h"
#include "simulate/core/check.h"
#include "simulate/flock/shape_targets.h"

namespace flocklift {

namespace {

// Of each id, in the first of these frames that has it, or else its position now.
std::vector<Vec3d> FirstSeen(const std::vector<Id>& ids, std::vector<Vec3d> position,
                             std::span<const FramePositions> frames) {
  for (std::size_t k = 0; k < ids.size(); ++k) {
    for (const FramePositions& frame : frames) {
      const auto found = std::lower_bound(frame.id.begin(), frame.id.end(), ids[k]);
      if (found == frame.id.end() || *found != ids[k]) continue;
      position[k] = frame.position[static_cast<std::size_t>(found - frame.id.begin())];
      break;
    }
  }
  return position;
}

}  // namespace

std::string WhyNoDeparture(const ModelSpec& model) {
  if (model.name == "shape") return "it flies to meshes, which trajectories do not hold";
  if (model.name == "morph") {
    return "it flies to the tetrahedra of meshes, which trajectories do not hold";
  }
  if (model.name == "crowd") {
    return "it walks in groups to goals of their own, which trajectories do not hold";
  }
  if (model.name == "forces" && model.terms.empty()) {
    return "it has no force but those that a scene gives it";
  }
  for (const ModelSpec& term : model.terms) {
    if (term.name == "wind" || term.name == "flee") {
      return "its term " + term.name + " feels what trajectories do not hold";
    }
  }
  return "";
}

Departures::Departures(const std::optional<Scene>& scene, const Parameters& parameters,
                       const Trajectories& seen, double fps, int substeps)
    : fps_(fps), substeps_(std::max(1, substeps)) {
  const ModelSpec& model = parameters.model;
  if (scene) {
    internal::SceneStart start = internal::StartIn(*scene, model.name, fps);
    world_ = std::move(start.world);
    swarm_ = std::move(start.swarm);
    substeps_ = start.substeps;
  } else if (const std::string why = WhyNoDeparture(model); !why.empty()) {
    throw InputError(model.where, 0,
                     "model " + model.name + " cannot be flown from trajectories alone: " + why,
                     "give the scene that does: --scene SCENE.toml");
  } else {
    swarm_.species = "fitted";
    world_.goals = parameters.goals;
  }
  world_.dt = 1 / (fps * substeps_);
  if (parameters.walls) world_.box = *parameters.walls;
  swarm_.model = ResolveModel(model);
  swarm_.spec = model;
  swarm_.forces = model.terms;
  settled_time_ = world_.time;
  if (model.name != "crowd" && model.name != "shape") return;
  seen_ = internal::FramesOf(seen);
  seen_time_ = (SpanOf(seen).first - 1) / fps;
}

Departure Departures::At(double time, const std::vector<Id>& ids,
                         const std::vector<Vec3d>& position, const std::vector<Vec3d>& velocity,
                         const std::vector<double>& cruising_speed) const {
  Departure departure{.world = world_, .swarm = swarm_, .place = {}};
  departure.world.time = time;
  std::vector<std::size_t> order(ids.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (swarm_.spec.name == "crowd")
    order = OrderByGoal(world_, swarm_.species, seen_, seen_time_, fps_, ids);
  Swarm& swarm = departure.swarm;
  swarm.position.clear();
  swarm.velocity.clear();
  swarm.cruising_speed.clear();
  departure.place.resize(ids.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    departure.place[order[k]] = k;
    swarm.position.push_back(position[order[k]]);
    swarm.velocity.push_back(velocity[order[k]]);
    swarm.cruising_speed.push_back(cruising_speed[order[k]]);
  }
  const double radius = swarm.radius.empty() ? 0 : swarm.radius.front();
  swarm.radius.assign(ids.size(), radius);
  if (swarm_.spec.name == "shape") swarm.settled = SettlingOf(time, ids, position);
  return departure;
}

Settling Departures::SettlingOf(double time, const std::vector<Id>& ids,
                                const std::vector<Vec3d>& position) const {
  Settling settled{.position = position, .time = settled_time_};
  const auto is_its = [&](const ShapeInTime& shape) { return shape.name == swarm_.shape; };
  const auto shape = std::find_if(world_.shapes.begin(), world_.shapes.end(), is_its);
  if (shape == world_.shapes.end()) return settled;  // the model will complain
  const std::string& name = swarm_.path.empty() ? shape->path : swarm_.path;
  const auto has_name = [&](const PathSpec& path) { return path.name == name; };
  const auto path = std::find_if(world_.paths.begin(), world_.paths.end(), has_name);
  const double frames = std::max(0.0, std::round((time - seen_time_) * fps_));
  const auto before = std::min(static_cast<std::size_t>(frames), seen_.size());
  const std::vector<Vec3d> first = FirstSeen(ids, position, std::span(seen_).first(before));
  // How much nearer everybody has come to the places that are settled from there.
  const auto progress = [&](const std::vector<Vec3d>& from) {
    ShapeTargets places(*shape, path == world_.paths.end() ? nullptr : &*path, world_.duration,
                        from, settled_time_, world_.seed, 1);
    ThreadPool pool(1);
    double sum = 0;
    const std::vector<Vec3d> then = places.At(seen_time_, &pool);
    for (std::size_t k = 0; k < ids.size(); ++k) sum += Norm(then[k] - first[k]);
    const std::vector<Vec3d>& now = places.At(time, &pool);
    for (std::size_t k = 0; k < ids.size(); ++k) sum -= Norm(now[k] - position[k]);
    return sum;
  };
  if (progress(first) > progress(position)) settled.position = first;
  return settled;
}

std::vector<std::size_t> NearestPaths(const std::vector<Id>& ids,
                                      std::span<const FramePositions> seen,
                                      std::span<const std::vector<Vec3d>> flown) {
  std::vector<std::size_t> nearest;
  for (const Id id : ids) {
    std::vector<double> apart(flown.empty() ? 1 : flown.front().size());
    for (std::size_t f = 0; f < seen.size(); ++f) {
      const auto found = std::lower_bound(seen[f].id.begin(), seen[f].id.end(), id);
      if (found == seen[f].id.end() || *found != id) continue;
      const Vec3d& place = seen[f].position[static_cast<std::size_t>(found - seen[f].id.begin())];
      for (std::size_t k = 0; k < apart.size(); ++k) apart[k] += SquaredNorm(flown[f][k] - place);
    }
    nearest.push_back(
        static_cast<std::size_t>(std::min_element(apart.begin(), apart.end()) - apart.begin()));
  }
  return nearest;
}

}  // namespace flocklift
