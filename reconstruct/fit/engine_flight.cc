// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/engine_flight.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "reconstruct/fit/crowd_start.h"
#include "reconstruct/fit/goal_groups.h"
#include "simulate/core/check.h"
#include "simulate/core/rng.h"
#include "simulate/flock/morph_motion.h"
#include "simulate/flock/population.h"

namespace flocklift::internal {
namespace {

constexpr std::uint32_t kStartStream = 0x57a27;  // of random numbers (simulate/core/rng.h)

// No more of the scene than its species' start needs.
Scene StartOf(Scene scene, const std::string& model) {
  const SpeciesSpec species = SpeciesOf(scene, model);
  scene.obstacles.clear();
  std::erase_if(scene.shapes,
                [&](const ShapeSpec& shape) { return shape.name != species.start_shape; });
  return scene;
}

// The flock as it is in the data's frame `start->first`.
void TakeFlock(const std::vector<FramePositions>& frames, Trajectories trajectories, double fps,
               FlightStart* start) {
  Swarm& swarm = start->swarm;
  const double radius = swarm.radius.empty() ? 0 : swarm.radius.front();
  const bool is_crowd = swarm.spec.name == "crowd";
  swarm.position.clear();
  swarm.velocity.clear();
  swarm.cruising_speed.clear();
  ComputeVelocities(fps, &trajectories);
  const int frame = SpanOf(trajectories).first + static_cast<int>(start->first);
  std::vector<Id> ids;
  for (const Trajectory& trajectory : trajectories.trajectories) {
    double speed = 0;
    std::optional<std::size_t> now;
    for (std::size_t k = 0; k < trajectory.points.size(); ++k) {
      const TrajectoryPoint& point = trajectory.points[k];
      speed += Norm(point.velocity) / static_cast<double>(trajectory.points.size());
      if (point.frame == frame) now = k;
    }
    if (!now) continue;
    ArrivalVelocity velocity{.mean = trajectory.points[*now].velocity, .doubt = {}};
    if (is_crowd) velocity = VelocityOfArrival(trajectory.points, *now, fps, start->substeps);
    ids.push_back(trajectory.id);
    swarm.position.push_back(trajectory.points[*now].position);
    swarm.velocity.push_back(velocity.mean);
    swarm.cruising_speed.push_back(speed);
    start->velocity_doubt.push_back(velocity.doubt);
  }
  swarm.radius.assign(ids.size(), radius);
  start->world.time = (frame - 1) / fps;
  if (!is_crowd) return;
  const std::vector<std::size_t> order =
      OrderByGoal(start->world, swarm.species, frames,
                  start->world.time - static_cast<double>(start->first) / fps, fps, ids);
  const Swarm unordered = swarm;
  const std::vector<Vec3d> doubt = start->velocity_doubt;
  for (std::size_t k = 0; k < order.size(); ++k) {
    swarm.position[k] = unordered.position[order[k]];
    swarm.velocity[k] = unordered.velocity[order[k]];
    swarm.cruising_speed[k] = unordered.cruising_speed[order[k]];
    start->velocity_doubt[k] = doubt[order[k]];
  }
}

}  // namespace

SceneStart StartIn(const Scene& scene, const std::string& model, double fps) {
  const SpeciesSpec& species = SpeciesOf(scene, model);
  SceneStart start;
  Population population = Populate(scene);
  start.world = std::move(population.world);
  for (Swarm& swarm : population.swarms) {
    if (swarm.species == species.name) start.swarm = std::move(swarm);
  }
  for (ShapeInTime& shape : start.world.shapes) {
    if (model != "morph") break;
    if (shape.name != start.swarm.shape && shape.name != start.swarm.start_shape) continue;
    shape.filling = FillWith(shape.meshes.front(), start.swarm.position.size());
  }
  start.substeps = std::max(1, static_cast<int>(std::lround(scene.fps * scene.substeps / fps)));
  return start;
}

std::vector<FramePositions> FramesOf(const Trajectories& trajectories) {
  const FrameSpan span = SpanOf(trajectories);
  std::vector<FramePositions> frames(static_cast<std::size_t>(span.last - span.first + 1));
  for (const Trajectory& trajectory : trajectories.trajectories) {  // by increasing id
    for (const TrajectoryPoint& point : trajectory.points) {
      FramePositions& frame = frames[static_cast<std::size_t>(point.frame - span.first)];
      frame.id.push_back(trajectory.id);
      frame.position.push_back(point.position);
    }
  }
  return frames;
}

const SpeciesSpec& SpeciesOf(const Scene& scene, const std::string& model) {
  for (const SpeciesSpec& species : scene.species) {
    if (species.model.name == model && species.count > 0) return species;
  }
  throw InputError("--scene", 0, "no species of the scene moves by the model " + model,
                   "name the model of one: --model");
}

FlightStart MakeFlightStart(const FitOptions& options, const FitProblem& problem,
                            const std::vector<FramePositions>& frames, Trajectories trajectories,
                            double fps) {
  FlightStart start;
  start.swarm.species = "fitted";
  start.substeps = std::max(1, options.substeps);
  if (problem.scene) {
    SceneStart in_scene = StartIn(*problem.scene, problem.model.name, fps);
    start.world = std::move(in_scene.world);
    start.swarm = std::move(in_scene.swarm);
    start.substeps = in_scene.substeps;
  }
  start.swarm.spec = problem.model;
  start.world.dt = 1 / (fps * start.substeps);
  if (problem.walls) start.world.box = *problem.walls;
  if (problem.goal == GoalChoice::kGiven) {
    GoalSpec goal;
    goal.position = problem.goal_position;
    goal.reach = problem.goal_reach;
    start.world.goals = {goal};
  }
  const bool morphs = problem.model.name == "morph";
  const auto most = options.statistics_time > 0 && !morphs
                        ? 1 + static_cast<std::size_t>(std::lround(options.statistics_time * fps))
                        : frames.size();
  if (problem.scene && (morphs || problem.model.name == "shape")) {
    if (!morphs) start.drawn = StartOf(*problem.scene, problem.model.name);
    start.frames = std::min(frames.size(), most);
    const double time = (SpanOf(trajectories).first - 1) / fps - start.world.time;
    start.steps_before = std::max<std::int64_t>(0, std::llround(time / start.world.dt));
    return start;
  }
  start.first = FullestFrame(frames);
  if (problem.model.name == "crowd") {
    const double time = (SpanOf(trajectories).first - 1) / fps - start.world.time;
    start.first = CrowdStartFrame(frames, problem.model, std::llround(time / start.world.dt),
                                  start.substeps, start.world.dt);
  }
  start.frames = std::min(frames.size() - start.first, most);
  TakeFlock(frames, std::move(trajectories), fps, &start);
  return start;
}

std::optional<std::vector<FramePositions>> Fly(const FlightStart& start, const ModelSpec& model,
                                               double own_speed, std::uint64_t seed) {
  World world = start.world;
  world.seed = seed;
  Swarm swarm = start.swarm;
  if (start.drawn) {
    Scene scene = *start.drawn;
    scene.seed = seed;
    for (Swarm& drawn : Populate(scene).swarms) {
      if (drawn.species == swarm.species) swarm = std::move(drawn);
    }
  }
  for (double& speed : swarm.cruising_speed) speed *= own_speed;
  for (std::size_t k = 0; k < start.velocity_doubt.size(); ++k) {
    swarm.velocity[k] += Rng(seed, k, kStartStream).Normal() * start.velocity_doubt[k];
  }
  std::vector<FramePositions> frames;
  try {
    swarm.model = ResolveModel(model);
    swarm.spec = model;
    swarm.forces = model.terms;
    Engine engine(world, {swarm}, {.threads = 1, .kernel = {}});
    for (std::int64_t step = 0; step < start.steps_before; ++step) engine.Step();
    for (std::size_t f = 0; f < start.frames; ++f) {
      for (int step = 0; f > 0 && step < start.substeps; ++step) engine.Step();
      FlockState state = engine.State();
      state.id.resize(swarm.position.size());
      state.position.resize(swarm.position.size());
      frames.push_back({std::move(state.id), std::move(state.position)});
    }
  } catch (const std::invalid_argument&) {
    return std::nullopt;  // numbers that do not go together
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
  return frames;
}

}  // namespace flocklift::internal
