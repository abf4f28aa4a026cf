// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/replay/replay.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <variant>

#include "reconstruct/metrics/flock_statistics.h"
#include "reconstruct/replay/guided_flight.h"
#include "simulate/core/check.h"
#include "simulate/core/rng.h"
#include "simulate/flock/engine.h"
#include "simulate/flock/load_scene.h"

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
  std::vector<Id> source;     // whose path each animal follows when guided
  std::vector<Vec3d> offset;  // ... and how far aside [m]
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
    start.source.push_back(state.id[source]);
    start.offset.push_back(offset);
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

// Flies the start on, a frame at a time.
class Flight {
 public:
  virtual ~Flight() = default;
  virtual FlockState NextFrame() = 0;
};

// By the engine, the model alone.
class FreeFlight : public Flight {
 public:
  FreeFlight(const World& world, const Swarm& swarm, int substeps, int threads)
      : engine_(world, {swarm}, {.threads = threads, .kernel = {}}), substeps_(substeps) {}
  FlockState NextFrame() override {
    for (int step = 0; step < substeps_; ++step) engine_.Step();
    return engine_.State();
  }

 private:
  Engine engine_;
  int substeps_;
};

class PulledFlight : public Flight {
 public:
  PulledFlight(const ReplayOptions& options, const Parameters& parameters,
               const Trajectories& reconstruction, const Start& start, int frame, double fps)
      : flight_(parameters, options.alpha, options.pull_time, start.swarm.position,
                start.swarm.velocity, start.swarm.cruising_speed),
        reconstruction_(reconstruction),
        start_(start),
        frame_(frame),
        substeps_(options.substeps),
        fps_(fps) {}

  FlockState NextFrame() override {
    const FlockState now = StateAtFrame(reconstruction_, frame_);
    const FlockState next = StateAtFrame(reconstruction_, ++frame_);
    std::unordered_map<Id, std::size_t> now_index, next_index;
    for (std::size_t k = 0; k < now.size(); ++k) now_index.emplace(now.id[k], k);
    for (std::size_t k = 0; k < next.size(); ++k) next_index.emplace(next.id[k], k);
    std::vector<std::optional<PathPoint>> paths(start_.id.size());
    for (int step = 0; step < substeps_; ++step) {
      const double u = static_cast<double>(step) / substeps_;
      for (std::size_t k = 0; k < paths.size(); ++k) {
        const auto a = now_index.find(start_.source[k]), b = next_index.find(start_.source[k]);
        paths[k].reset();
        if (a == now_index.end() || b == next_index.end()) continue;
        const Vec3d& from = now.position[a->second];
        const Vec3d& to = next.position[b->second];
        paths[k] = PathPoint{from + u * (to - from) + start_.offset[k], (to - from) * fps_};
      }
      flight_.Step(paths, 1 / (fps_ * substeps_));
    }
    return {start_.id, flight_.position(), flight_.velocity()};
  }

 private:
  GuidedFlight flight_;
  const Trajectories& reconstruction_;
  const Start& start_;
  int frame_, substeps_;
  double fps_;
};

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

}  // namespace

ReplayResult Replay(const ReplayOptions& options, const Parameters& parameters,
                    const Trajectories& reconstruction, double fps, std::uint64_t seed, int threads,
                    const Progress& progress, const std::vector<ObstacleSpec>& obstacles) {
  CheckOptions(options);
  Check(fps > 0, "fps must be positive to replay");
  Check(reconstruction.has_velocity, "a replay starts from velocities: fill them first");
  CheckObstacles(options, parameters.model, obstacles);
  ReplayResult result;
  result.start_frame = options.frame > 0 ? options.frame : FullestFrame(reconstruction);
  Start start = MakeStart(reconstruction, result.start_frame, options.count, seed);
  start.swarm.model = ResolveModel(parameters.model);
  start.swarm.forces = parameters.model.terms;
  const int frames = options.duration > 0 ? static_cast<int>(std::lround(options.duration * fps))
                                          : SpanOf(reconstruction).last - result.start_frame;

  World world{.seed = seed,
              .dt = 1 / (fps * options.substeps),
              .time = (result.start_frame - 1) / fps,
              .goals = parameters.goals,
              .predators = {}};
  if (parameters.walls) world.box = *parameters.walls;
  Scene scene;
  scene.obstacles = obstacles;
  world.obstacles = LoadObstacles(scene);
  std::unique_ptr<Flight> flight, perturbed, noiseless;
  if (options.alpha < 1) {
    flight = std::make_unique<PulledFlight>(options, parameters, reconstruction, start,
                                            result.start_frame, fps);
  } else {
    if (options.noiseless) start.swarm = Noiseless(start.swarm);
    flight = std::make_unique<FreeFlight>(world, start.swarm, options.substeps, threads);
    perturbed = std::make_unique<FreeFlight>(world, Perturbed(start.swarm, seed), options.substeps,
                                             threads);
    noiseless =
        std::make_unique<FreeFlight>(world, Noiseless(start.swarm), options.substeps, threads);
  }
  result.replayed.fps = fps;
  result.replayed.has_velocity = result.replayed.has_orientation = true;
  for (const Id id : start.id) result.replayed.trajectories.push_back({.id = id, .points = {}});

  Append({start.id, start.swarm.position, start.swarm.velocity}, result.start_frame,
         &result.replayed);
  for (int k = 1; k <= frames; ++k) {
    const int frame = result.start_frame + k;
    const FlockState state = flight->NextFrame();
    Append(state, frame, &result.replayed);
    const FlockState there = StateAtFrame(reconstruction, frame);
    Divergence divergence = Compare(there, start.id, state, start.swarm, k / fps);
    divergence.noiseless_rms = divergence.model_rms;
    if (perturbed) {
      divergence.perturbed_rms = RmsDistance(state.position, perturbed->NextFrame().position);
      divergence.noiseless_rms =
          Compare(there, start.id, noiseless->NextFrame(), start.swarm, k / fps).model_rms;
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
