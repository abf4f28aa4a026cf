// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/replay/replay.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>

#include "reconstruct/metrics/flock_statistics.h"
#include "simulate/core/check.h"
#include "simulate/core/rng.h"
#include "simulate/flock/engine.h"

namespace flocklift {
namespace {

// The first frame with most animals.
int FullestFrame(const Trajectories& trajectories) {
  std::map<int, int> counts;
  for (const Trajectory& trajectory : trajectories.trajectories) {
    for (const TrajectoryPoint& point : trajectory.points) ++counts[point.frame];
  }
  int best = 0, most = 0;
  for (const auto& [frame, count] : counts) {
    if (count > most) {
      most = count;
      best = frame;
    }
  }
  return best;
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

// The flock at the start: its animals, then copies of randomly chosen ones.
struct Start {
  std::vector<Id> id;
  Swarm swarm;
};

Start MakeStart(const Trajectories& reconstruction, int frame, int count, std::uint64_t seed) {
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
  Start start;
  start.swarm.species = "replay";
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
    start.swarm.position.push_back(state.position[source] + offset);
    start.swarm.velocity.push_back(state.velocity[source]);
    start.swarm.cruising_speed.push_back(cruising_speed.at(state.id[source]));
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
                   const FlockState& replayed, const Swarm& start, double time) {
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

}  // namespace

ReplayResult Replay(const ReplayOptions& options, const ModelSpec& model,
                    const Trajectories& reconstruction, double fps, std::uint64_t seed, int threads,
                    const Progress& progress) {
  CheckOptions(options);
  Check(fps > 0, "fps must be positive to replay");
  Check(reconstruction.has_velocity, "a replay starts from velocities: fill them first");
  ReplayResult result;
  result.start_frame = options.frame > 0 ? options.frame : FullestFrame(reconstruction);
  Start start = MakeStart(reconstruction, result.start_frame, options.count, seed);
  start.swarm.model = ResolveModel(model);
  const int frames = options.duration > 0 ? static_cast<int>(std::lround(options.duration * fps))
                                          : SpanOf(reconstruction).last - result.start_frame;

  const World world{.seed = seed,
                    .dt = 1 / (fps * options.substeps),
                    .time = (result.start_frame - 1) / fps,
                    .goals = {},
                    .predators = {}};
  Engine engine(world, {start.swarm}, {.threads = threads, .kernel = {}});
  result.replayed.fps = fps;
  result.replayed.has_velocity = result.replayed.has_orientation = true;
  for (const Id id : start.id) result.replayed.trajectories.push_back({.id = id, .points = {}});

  Append(engine.State(), result.start_frame, &result.replayed);
  for (int k = 1; k <= frames; ++k) {
    for (int step = 0; step < options.substeps; ++step) engine.Step();
    const int frame = result.start_frame + k;
    const FlockState state = engine.State();
    Append(state, frame, &result.replayed);
    const Divergence divergence =
        Compare(StateAtFrame(reconstruction, frame), start.id, state, start.swarm, k / fps);
    if (divergence.animals > 0) result.divergence.push_back(divergence);
    Report(progress, k, frames);
  }
  // By increasing id, as everywhere; the engine kept the order of the start.
  std::sort(result.replayed.trajectories.begin(), result.replayed.trajectories.end(),
            [](const Trajectory& a, const Trajectory& b) { return a.id < b.id; });
  return result;
}

}  // namespace flocklift
