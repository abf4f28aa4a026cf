// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/statistics_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "reconstruct/fit/simulated_fit.h"
#include "simulate/core/check.h"
#include "simulate/core/suggest.h"
#include "simulate/flock/engine.h"

namespace flocklift::internal {
namespace {

constexpr double kMisfit = 2;  // sd from seed to seed: above, a statistic is not matched

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

// Where simulations start, and how long they last.
struct Start {
  World world;
  Swarm swarm;
  std::size_t first = 0, frames = 0;  // of the data's
  int substeps = 1;
};

Start MakeStart(const FitOptions& options, const FitProblem& problem, Trajectories trajectories,
                double fps) {
  const std::vector<FramePositions> frames = FramesOf(trajectories);
  Start start;
  const auto fullest =
      std::max_element(frames.begin(), frames.end(),
                       [](const auto& a, const auto& b) { return a.id.size() < b.id.size(); });
  start.first = static_cast<std::size_t>(fullest - frames.begin());
  start.frames = frames.size() - start.first;
  if (options.statistics_time > 0) {
    start.frames = std::min(
        start.frames, 1 + static_cast<std::size_t>(std::lround(options.statistics_time * fps)));
  }
  ComputeVelocities(fps, &trajectories);
  const int frame = SpanOf(trajectories).first + static_cast<int>(start.first);
  start.swarm.species = "fitted";
  for (const Trajectory& trajectory : trajectories.trajectories) {
    double speed = 0;
    const TrajectoryPoint* now = nullptr;
    for (const TrajectoryPoint& point : trajectory.points) {
      speed += Norm(point.velocity) / static_cast<double>(trajectory.points.size());
      if (point.frame == frame) now = &point;
    }
    if (now == nullptr) continue;
    start.swarm.position.push_back(now->position);
    start.swarm.velocity.push_back(now->velocity);
    start.swarm.cruising_speed.push_back(speed);
  }
  start.substeps = std::max(1, options.substeps);
  start.world.dt = 1 / (fps * start.substeps);
  start.world.time = (frame - 1) / fps;
  if (problem.walls) start.world.box = *problem.walls;
  if (problem.goal == GoalChoice::kGiven) {
    GoalSpec goal;
    goal.position = problem.goal_position;
    goal.reach = problem.goal_reach;
    start.world.goals = {goal};
  }
  return start;
}

std::optional<MotionStatistics> Simulated(const Start& start, const ModelSpec& model,
                                          double own_speed, std::uint64_t seed) {
  World world = start.world;
  world.seed = seed;
  Swarm swarm = start.swarm;
  for (double& speed : swarm.cruising_speed) speed *= own_speed;
  std::vector<FramePositions> frames;
  try {
    swarm.model = ResolveModel(model);
    Engine engine(world, {swarm}, {.threads = 1, .kernel = {}});
    for (std::size_t f = 0; f < start.frames; ++f) {
      for (int step = 0; f > 0 && step < start.substeps; ++step) engine.Step();
      const FlockState state = engine.State();
      frames.push_back({state.id, state.position});
    }
  } catch (const std::runtime_error&) {
    return std::nullopt;  // out of range, or a flock that flew apart
  }
  return ComputeMotionStatistics(frames, start.world.dt * start.substeps);
}

std::vector<double> StartValues(const ModelSpec& model, const std::vector<std::string>& free) {
  std::vector<double> values;
  std::vector<std::string> known;
  for (const auto& [name, value] : model.parameters) known.push_back(name);
  for (const std::string& name : free) {
    const auto found = model.parameters.find(name);
    if (found == model.parameters.end()) {
      throw InputError("--free", 0,
                       "model " + model.name + " has no number `" + name + "` to be fitted",
                       SuggestName(name, known));
    }
    if (!(found->second > 0)) {
      throw InputError(model.WhereOf(name), 0, "`" + name + "` cannot start from 0",
                       "give --set " + name + "=VALUE, of about the right size");
    }
    values.push_back(found->second);
  }
  return values;
}

void AddWeights(const std::vector<std::string>& free, const SimulatedFit& fit, double known,
                FitResult* result) {
  ParameterPosterior& posterior = result->parameters.posterior;
  for (std::size_t k = 0; k < free.size(); ++k) {
    FittedWeight weight;
    weight.name = free[k];
    weight.value = weight.estimate = fit.estimate[k];
    weight.sd = fit.estimate[k] * fit.log_sd[k];
    weight.plain = std::nan("");
    weight.determined = 1.96 * fit.log_sd[k] < known;
    result->parameters.model.parameters[free[k]] = weight.value;
    posterior.free.push_back(weight.name);
    posterior.sd.push_back(weight.sd);
    posterior.determined.push_back(weight.determined);
    result->weights.push_back(weight);
  }
  const std::size_t p = fit.estimate.size();
  for (std::size_t a = 0; a < free.size(); ++a) {
    const auto row = fit.correlation.begin() + static_cast<std::ptrdiff_t>(a * p);
    posterior.correlation.insert(posterior.correlation.end(), row,
                                 row + static_cast<std::ptrdiff_t>(free.size()));
  }
}

}  // namespace

std::vector<std::string> StatisticsParameters(const ModelSpec& model) {
  if (model.name == "bswarm") return {"w_rep", "w_ali", "w_att", "r_rep", "r_ali", "r_att"};
  if (model.name == "lin") return {"w_sep", "d_sep", "gain"};
  if (model.name == "opensteer") {
    return {"separation_weight", "alignment_weight", "cohesion_weight",
            "separation_radius", "alignment_radius", "cohesion_radius"};
  }
  return {};
}

FitResult FitStatistics(const FitOptions& options, const FitProblem& problem,
                        const Trajectories& trajectories, double fps, std::uint64_t seed,
                        int threads, const Progress& progress) {
  ModelSpec model = CompleteModel(problem.model);
  const std::vector<std::string> free =
      problem.free.empty() ? StatisticsParameters(model) : problem.free;
  if (free.empty()) {
    throw InputError(model.where, 0, "nothing is named to be fitted by statistics", "give --free");
  }
  std::vector<double> values = StartValues(model, free);
  FitResult result;
  result.method = FitMethod::kStatistics;
  result.parameters.model = model;
  result.parameters.walls = problem.walls;
  result.animals = static_cast<int>(trajectories.trajectories.size());
  if (result.animals < 2) {
    result.status = FitStatus::kTooFewAnimals;
    return result;
  }
  const Start start = MakeStart(options, problem, trajectories, fps);
  result.parameters.goals = start.world.goals;
  result.frames = static_cast<int>(start.frames);
  const std::vector<FramePositions> frames = FramesOf(trajectories);
  const std::optional<MotionStatistics> data =
      ComputeMotionStatistics(std::span(frames).subspan(start.first, start.frames), 1 / fps);
  if (!data) {
    result.status = FitStatus::kTooFewFrames;
    return result;
  }
  // The speed that animals would fly alone, as a share of what they do fly, is one more unknown.
  const auto drive = model.parameters.find("drive");
  const bool own_speed = drive != model.parameters.end() && drive->second > 0;
  const auto simulate = [&](const std::vector<double>& theta, std::uint64_t of) {
    ModelSpec spec = model;
    for (std::size_t k = 0; k < free.size(); ++k) spec.parameters[free[k]] = theta[k];
    return Simulated(start, spec, own_speed ? theta.back() : 1, of);
  };
  SimulatedFitOptions search;
  search.search = problem.search;
  search.global_evaluations = options.global_evaluations;
  search.local_evaluations = options.local_evaluations;
  search.range = options.search_range;
  search.seed = seed;
  search.threads = threads;
  if (own_speed) {
    values.push_back(1);
    search.nuisance = 1;
  }
  const SimulatedFit fit = FitSimulated(search, simulate, *data, values, progress);
  if (!fit.usable) {
    throw InputError(model.where, 0, "the model does not fly from where the fit starts",
                     "give other values by --set");
  }
  result.rows = result.animals * static_cast<std::int64_t>(result.frames);
  AddWeights(free, fit, search.known, &result);
  if (own_speed) {
    for (const double speed : start.swarm.cruising_speed) {
      result.own_speed_mean +=
          fit.estimate.back() * speed / static_cast<double>(start.swarm.cruising_speed.size());
    }
  }
  for (std::size_t k = 0; k < kMotionStatistics.size(); ++k) {
    result.misfit.push_back({std::string(kMotionStatistics[k]), fit.misfit[k]});
    if (!(fit.misfit[k] > kMisfit)) continue;
    result.warnings.push_back(
        fmt::format("the model's {} is {:.1f} times the spread from seed to seed off the data's",
                    kMotionStatistics[k], fit.misfit[k]));
  }
  return result;
}

}  // namespace flocklift::internal
