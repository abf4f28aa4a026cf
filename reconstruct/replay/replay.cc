// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/replay/replay.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <variant>

#include "reconstruct/metrics/flock_statistics.h"
#include "reconstruct/replay/replay_flight.h"
#include "simulate/core/check.h"
#include "simulate/core/rng.h"
#include "simulate/flock/engine.h"
#include "simulate/flock/load_scene.h"

namespace flocklift {
namespace {

// Where most is to be compared with: the first frame whose animals are seen in most of the frames
// that are flown from there on, all together. (Most at once may be there just before the end.)
int FrameToStartAt(const Trajectories& trajectories, std::size_t flown) {
  std::map<int, std::size_t> ahead;
  for (const Trajectory& trajectory : trajectories.trajectories) {
    std::size_t left = trajectory.points.size();
    for (const TrajectoryPoint& point : trajectory.points) {
      ahead[point.frame] += std::min(left--, flown);
    }
  }
  const auto best = std::max_element(
      ahead.begin(), ahead.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return best == ahead.end() ? 0 : best->first;
}

double MeanSpeed(const Trajectory& trajectory) {
  double sum = 0;
  for (const TrajectoryPoint& point : trajectory.points) sum += Norm(point.velocity);
  return sum / static_cast<double>(trajectory.points.size());
}

double MedianNeighbourDistance(const FlockState& state) {
  std::vector<double> distances = NearestNeighbourDistances(state.position);
  if (distances.empty()) return 1;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

ReplayStart MakeStart(const Trajectories& reconstruction, int frame, int count,
                      std::uint64_t seed) {
  const FlockState state = StateAtFrame(reconstruction, frame);
  Check(state.size() > 0, "frame " + std::to_string(frame) + " has no animals to start from");
  std::unordered_map<Id, double> cruising_speed;
  Id last_id = 0;
  for (const Trajectory& trajectory : reconstruction.trajectories) {
    cruising_speed[trajectory.id] = MeanSpeed(trajectory);
    last_id = std::max(last_id, trajectory.id);
  }
  const std::size_t wanted = count > 0 ? static_cast<std::size_t>(count) : state.size();
  const double spacing = MedianNeighbourDistance(state);
  ReplayStart start;
  start.frame = frame;
  for (std::size_t k = 0; k < wanted; ++k) {
    std::size_t source = k;
    Vec3d offset;
    Id id = 0;
    if (k < state.size()) {
      id = state.id[k];
    } else {
      Rng rng(seed, k);
      source = rng.Below(static_cast<std::uint32_t>(state.size()));
      offset = Vec3d{rng.Normal(), rng.Normal(), rng.Normal()} * spacing;
      id = ++last_id;
    }
    start.id.push_back(id);
    start.source.push_back(state.id[source]);
    start.offset.push_back(offset);
    start.position.push_back(state.position[source] + offset);
    start.velocity.push_back(state.velocity[source]);
    start.cruising_speed.push_back(cruising_speed.at(state.id[source]));
  }
  return start;
}

void Append(const FlockState& state, int frame, Trajectories* replayed) {
  for (std::size_t k = 0; k < state.size(); ++k) {
    TrajectoryPoint point;
    point.frame = frame;
    point.position = state.position[k];
    point.velocity = state.velocity[k];
    point.world_from_body = QuaternionFromRotation(WorldFromLevelBody(point.velocity));
    replayed->trajectories[k].points.push_back(point);
  }
}

Divergence Compare(const FlockState& reconstruction, const std::vector<Id>& ids,
                   const FlockState& replayed, const ReplayStart& start, double time) {
  std::unordered_map<Id, Vec3d> truth;
  for (std::size_t k = 0; k < reconstruction.size(); ++k) {
    truth.emplace(reconstruction.id[k], reconstruction.position[k]);
  }
  Divergence divergence{.time = time};
  for (std::size_t k = 0; k < ids.size(); ++k) {
    const auto found = truth.find(ids[k]);
    if (found == truth.end()) continue;
    ++divergence.animals;
    divergence.model_rms += SquaredNorm(replayed.position[k] - found->second);
    divergence.straight_on_rms +=
        SquaredNorm(start.position[k] + start.velocity[k] * time - found->second);
  }
  const double n = std::max(divergence.animals, 1);
  divergence.model_rms = std::sqrt(divergence.model_rms / n);
  divergence.straight_on_rms = std::sqrt(divergence.straight_on_rms / n);
  return divergence;
}

struct SetNoise {
  double value;
  void operator()(BoidsParameters<double>& p) const { p.noise = value; }
  void operator()(LinearParameters<double>& p) const { p.diffusion = value; }
  template <typename Noiseless>  // or whose noise is a field in space
  void operator()(Noiseless&) const {}
};

Swarm Noiseless(Swarm swarm) {
  std::visit(SetNoise{0}, swarm.model);
  std::erase_if(swarm.forces, [](const ModelSpec& term) { return term.name == "noise"; });
  return swarm;
}

Swarm Perturbed(Swarm swarm, std::uint64_t seed) {
  for (std::size_t k = 0; k < swarm.position.size(); ++k) {
    Rng rng(seed, (std::uint64_t{1} << 63) | k);
    swarm.position[k] += kPerturbation * Vec3d{rng.Normal(), rng.Normal(), rng.Normal()};
  }
  return swarm;
}

double RmsDistance(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += SquaredNorm(a[k] - b[k]);
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(a.size(), 1)));
}

void CheckObstacles(const ReplayOptions& options, const ModelSpec& model,
                    const std::vector<ObstacleSpec>& obstacles) {
  if (obstacles.empty()) return;
  constexpr const char* kAvoiding[] = {"bswarm", "shape", "swarm"};
  if (std::find(std::begin(kAvoiding), std::end(kAvoiding), model.name) == std::end(kAvoiding)) {
    throw InputError(model.where, 0, "model " + model.name + " sees no obstacles",
                     "leave --obstacle out, or fit bswarm, shape or swarm");
  }
  Check(options.alpha == 1, "obstacles stand in free flights only: leave out --alpha");
}

// What the terms of the scene's species feel, as it is when a flight starts.
TermSurroundings Around(const Departures& departures, const Parameters& parameters, double time) {
  TermSurroundings around{.walls = parameters.walls};
  around.goals = departures.world().goals;
  for (GoalSpec& goal : around.goals) goal.position = GoalPosition(goal, time);
  around.wind = departures.world().wind.velocity;
  around.flat = departures.world().dimensions == 2;
  return around;
}

}  // namespace

ReplayResult Replay(const ReplayOptions& options, const Parameters& parameters,
                    const Trajectories& reconstruction, double fps, std::uint64_t seed, int threads,
                    const Progress& progress, const std::vector<ObstacleSpec>& obstacles,
                    const std::optional<Scene>& scene) {
  CheckOptions(options);
  Check(fps > 0, "fps must be positive to replay");
  Check(reconstruction.has_velocity, "a replay starts from velocities: fill them first");
  CheckObstacles(options, parameters.model, obstacles);
  ReplayResult result;
  const int asked = static_cast<int>(std::lround(options.duration * fps));
  result.start_frame =
      options.frame > 0
          ? options.frame
          : FrameToStartAt(reconstruction, asked > 0 ? static_cast<std::size_t>(asked) + 1
                                                     : std::numeric_limits<std::size_t>::max());
  const Departures departures(scene, parameters, reconstruction, fps, options.substeps);
  const int substeps = departures.substeps();
  const bool from_scene_start = DepartsFromSceneStart(parameters.model);
  Check(!from_scene_start || (options.alpha == 1 && options.count == 0),
        "tetrahedra that morph fly as their scene has them: leave out --alpha and --count");
  ReplayStart start = MakeStart(reconstruction, result.start_frame, options.count, seed);
  const int frames =
      options.duration > 0 ? asked : SpanOf(reconstruction).last - result.start_frame;
  const double time = (result.start_frame - 1) / fps;
  std::unique_ptr<ReplayFlight> flight, perturbed, noiseless;
  if (from_scene_start) {
    flight = FlyFromSceneStart(departures, seed, threads, reconstruction, fps, &start);
  } else if (options.alpha < 1) {
    flight = FlyPulled(parameters, Around(departures, parameters, time), options.alpha,
                       options.pull_time, substeps, reconstruction, start, fps);
  } else {
    Departure from =
        departures.At(time, start.id, start.position, start.velocity, start.cruising_speed);
    from.world.seed = seed;
    Scene others;
    others.obstacles = obstacles;
    for (Obstacle& obstacle : LoadObstacles(others)) {
      from.world.obstacles.push_back(std::move(obstacle));
    }
    if (options.noiseless) from.swarm = Noiseless(from.swarm);
    const auto fly = [&](const Swarm& swarm) {
      return FlyFreely(start.id, {from.world, swarm, from.place}, substeps, threads);
    };
    flight = fly(from.swarm);
    perturbed = fly(Perturbed(from.swarm, seed));
    noiseless = fly(Noiseless(from.swarm));
  }
  result.replayed.fps = fps;
  result.replayed.has_velocity = result.replayed.has_orientation = true;
  for (const Id id : start.id) result.replayed.trajectories.push_back({.id = id, .points = {}});

  Append({start.id, start.position, start.velocity}, result.start_frame, &result.replayed);
  for (int k = 1; k <= frames; ++k) {
    const int frame = result.start_frame + k;
    const FlockState state = flight->NextFrame();
    Append(state, frame, &result.replayed);
    const FlockState there = StateAtFrame(reconstruction, frame);
    Divergence divergence = Compare(there, start.id, state, start, k / fps);
    divergence.noiseless_rms = divergence.model_rms;
    if (perturbed) {
      divergence.perturbed_rms = RmsDistance(state.position, perturbed->NextFrame().position);
      divergence.noiseless_rms =
          Compare(there, start.id, noiseless->NextFrame(), start, k / fps).model_rms;
    }
    if (divergence.animals > 0) result.divergence.push_back(divergence);
    Report(progress, k, frames);
  }
  // By increasing id, as everywhere; the engine kept the order of the start.
  std::sort(result.replayed.trajectories.begin(), result.replayed.trajectories.end(),
            [](const Trajectory& a, const Trajectory& b) { return a.id < b.id; });
  return result;
}

}  // namespace flocklift
