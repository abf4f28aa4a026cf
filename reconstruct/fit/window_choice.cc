// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/window_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <unordered_map>

#include "reconstruct/fit/fit_scene.h"
#include "simulate/flock/engine.h"

namespace flocklift::internal {
namespace {

constexpr double kLead = 1;           // of the flights that choose [s]
constexpr int kStarts = 12;           // of flights
constexpr double kClearly = 0.9;      // of E^2
constexpr double kFewestSeconds = 2;  // that flights are worth

// The model without what it draws.
ModelSpec Noiseless(ModelSpec model) {
  for (const char* name : {"noise", "diffusion"}) {
    const auto found = model.parameters.find(name);
    if (found != model.parameters.end()) found->second = 0;
  }
  std::erase_if(model.terms, [](const ModelSpec& term) { return term.name == "noise"; });
  return model;
}

std::unordered_map<Id, double> MeanSpeeds(const Trajectories& trajectories) {
  std::unordered_map<Id, double> speeds;
  for (const Trajectory& trajectory : trajectories.trajectories) {
    double& speed = speeds[trajectory.id];
    for (const TrajectoryPoint& point : trajectory.points) {
      speed += Norm(point.velocity) / static_cast<double>(trajectory.points.size());
    }
  }
  return speeds;
}

}  // namespace

FlownErrors FlyOn(const Parameters& parameters, const Trajectories& trajectories, double fps,
                  int substeps, double lead, const TermSurroundings& around) {
  Trajectories moving = trajectories;
  if (!moving.has_velocity) ComputeVelocities(fps, &moving);
  const std::unordered_map<Id, double> speeds = MeanSpeeds(moving);
  const FrameSpan span = SpanOf(moving);
  const int length = span.last - span.first;
  const int ahead = std::min(static_cast<int>(std::lround(lead * fps)), length / 3);
  Swarm swarm;
  swarm.species = "fitted";
  const ModelSpec noiseless = Noiseless(parameters.model);
  swarm.model = ResolveModel(noiseless);
  swarm.forces = noiseless.terms;
  World world;
  const int steps = std::max(1, substeps);
  world.dt = 1 / (fps * steps);
  world.goals = parameters.goals;
  if (parameters.walls) world.box = *parameters.walls;
  world.wind.velocity = around.wind;
  if (around.flat) world.dimensions = 2;
  double model = 0, straight_on = 0, count = 0;
  for (int k = 0; k < kStarts && ahead > 0; ++k) {
    const int start = span.first + static_cast<int>((k + 0.5) * (length - ahead) / kStarts);
    const FlockState now = StateAtFrame(moving, start), then = StateAtFrame(moving, start + ahead);
    if (now.size() == 0) continue;
    swarm.position = now.position;
    swarm.velocity = now.velocity;
    swarm.cruising_speed.clear();
    for (const Id id : now.id) swarm.cruising_speed.push_back(speeds.at(id));
    world.time = (start - 1) / fps;
    Engine engine(world, {swarm}, {.threads = 1, .kernel = {}});
    for (int step = 0; step < ahead * steps; ++step) engine.Step();
    const FlockState flown = engine.State();
    std::unordered_map<Id, Vec3d> there;
    for (std::size_t i = 0; i < then.size(); ++i) there.emplace(then.id[i], then.position[i]);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const auto found = there.find(now.id[i]);
      if (found == there.end()) continue;
      model += SquaredNorm(flown.position[i] - found->second);
      straight_on += SquaredNorm(now.position[i] + (ahead / fps) * now.velocity[i] - found->second);
      count += 1;
    }
  }
  if (count == 0) return {};
  return {std::sqrt(model / count), std::sqrt(straight_on / count)};
}

int ChooseWindowByFlight(const FitOptions& options, const RadiusChoice& choice,
                         const Trajectories& trajectories, double fps, std::uint64_t seed,
                         int threads) {
  const FrameSpan span = SpanOf(trajectories);
  if (span.last - span.first < kFewestSeconds * fps) return 0;
  FitOptions quick = options;
  quick.held_out = 0;
  quick.depth_draws = 0;
  // The error of the fit over a window, and the window.
  const auto error = [&](int* window) {
    quick.window = *window;
    Fitter fitter(quick, choice.problem, trajectories, fps, seed, threads);
    fitter.Assume(choice.noise);
    const FitResult fit = fitter.Run({});
    const bool flies = fit.IsUsable() && fit.method == FitMethod::kErrorsInVariables;
    if (*window == 0) *window = flies ? fit.window : 0;
    if (!flies) return std::numeric_limits<double>::infinity();
    try {
      return FlyOn(fit.parameters, trajectories, fps, options.substeps, kLead,
                   SurroundingsOf(choice.problem))
          .model;
    } catch (const std::runtime_error&) {
      return std::numeric_limits<double>::infinity();  // it flew apart
    }
  };
  int chosen = 0;
  double least = error(&chosen);
  if (chosen == 0) return 0;
  const int by_noise = chosen;
  least *= std::sqrt(kClearly);
  for (int window = 1; window <= options.longest_window * fps; window *= 2) {
    if (window == by_noise) continue;
    const double here = error(&window);
    if (!(here < least)) continue;
    least = here;
    chosen = window;
  }
  return chosen;
}

}  // namespace flocklift::internal
