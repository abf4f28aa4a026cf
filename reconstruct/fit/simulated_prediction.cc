// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/simulated_prediction.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>

#include "reconstruct/fit/departure.h"
#include "reconstruct/fit/engine_flight.h"
#include "reconstruct/fit/expected_field.h"
#include "reconstruct/fit/fit_scene.h"
#include "reconstruct/fit/fit_setup.h"
#include "reconstruct/fit/flock_terms.h"
#include "reconstruct/fit/held_out.h"
#include "reconstruct/fit/motion_rows.h"
#include "reconstruct/fit/noise_search.h"
#include "reconstruct/fit/statistics_fit.h"
#include "reconstruct/fit/swarm_noise.h"
#include "simulate/core/check.h"
#include "simulate/core/parallel_for.h"
#include "simulate/flock/engine.h"

namespace flocklift {
namespace {

constexpr int kSeeds = 8;            // R
constexpr int kWindows = 40;         // of each part, at most, that are flown
constexpr int kMatched = 12;         // frames, about, that paths are compared in
constexpr int kFieldAnimals = 1000;  // that a field which stands still is expected of
constexpr std::int64_t kFewestRows = 10;

// A window: the state foreseen in its first frame, `middle` - m.
struct Window {
  int middle = 0;
  ObservedFlock::State state;
};
// For every seed, every animal's second difference through a window [m/s^2]; none where the model
// does not fly from there.
using Flight = std::function<std::vector<std::vector<Vec3d>>(const Window&)>;

struct Sums {
  double product = 0, predicted = 0, observed = 0;
  std::int64_t rows = 0;

  void operator+=(const Sums& other) {
    product += other.product;
    predicted += other.predicted;
    observed += other.observed;
    rows += other.rows;
  }
};

class Scorer {
 public:
  Scorer(const ObservedFlock& flock, int window, int threads)
      : flock_(flock), window_(window), threads_(threads) {}

  // Over windows that lie within frames first .. last.
  Sums Score(int first, int last, const Flight& fly) const {
    const int low = first + window_ + 2, high = last - window_ - 1;
    const int step = std::max(1, (high - low + kWindows) / kWindows);
    const int count = high < low ? 0 : (high - low) / step + 1;
    std::vector<Sums> parts(static_cast<std::size_t>(count));
    ParallelFor(threads_, 0, count, 1, [&](std::int64_t k, std::int64_t) {
      parts[static_cast<std::size_t>(k)] = Of(low + static_cast<int>(k) * step, fly);
    });
    Sums sums;
    for (const Sums& part : parts) sums += part;
    return sums;
  }

 private:
  Sums Of(int middle, const Flight& fly) const {
    const int m = window_;
    const Window window{middle, flock_.Foreseen(middle - m - 2, 3 * m, 2)};
    Sums sums;
    const std::vector<std::vector<Vec3d>> flown = fly(window);
    if (flown.empty()) return sums;
    const auto seeds = static_cast<double>(flown.size());
    const double width = m * flock_.dt();
    for (std::size_t i = 0; i < window.state.animal.size(); ++i) {
      const int animal = window.state.animal[i];
      bool measured = true;
      for (int f = middle - m - 2; f <= middle + m + 1; ++f) {
        measured = measured && flock_.Measured(animal, f);
      }
      if (!measured) continue;
      const Vec3d y = (flock_.Position(animal, middle + m) - 2.0 * flock_.Position(animal, middle) +
                       flock_.Position(animal, middle - m)) /
                      (width * width);
      Vec3d sum;
      double squares = 0;
      for (const std::vector<Vec3d>& one : flown) {
        sum += one[i];
        squares += SquaredNorm(one[i]);
      }
      sums.product += Dot(y, sum) / seeds;
      sums.predicted += seeds > 1 ? (SquaredNorm(sum) - squares) / (seeds * (seeds - 1)) : squares;
      sums.observed += SquaredNorm(y);
      ++sums.rows;
    }
    return sums;
  }

  const ObservedFlock& flock_;
  int window_, threads_;
};

// Each animal's mean speed before `split`, times the factor that the fit has found [m/s].
std::vector<double> OwnSpeeds(const Trajectories& trajectories, double fps, int split,
                              double fitted_mean) {
  Trajectories moving = trajectories;
  ComputeVelocities(fps, &moving);
  std::vector<double> speeds;
  double all = 0, known = 0;
  for (const Trajectory& trajectory : moving.trajectories) {
    double sum = 0, count = 0;
    for (const TrajectoryPoint& point : trajectory.points) {
      if (point.frame >= split) break;
      sum += Norm(point.velocity);
      count += 1;
    }
    speeds.push_back(count > 0 ? sum / count : -1);
    if (count == 0) continue;
    all += sum / count;
    known += 1;
  }
  const double mean = known > 0 ? all / known : 0;
  const double factor = fitted_mean > 0 && mean > 0 ? fitted_mean / mean : 1;
  for (double& speed : speeds) speed = factor * (speed < 0 ? mean : speed);
  return speeds;
}

std::vector<Vec3d> SecondDifference(const std::vector<Vec3d>& before,
                                    const std::vector<Vec3d>& middle,
                                    const std::vector<Vec3d>& after, double width) {
  std::vector<Vec3d> difference;
  for (std::size_t k = 0; k < before.size(); ++k) {
    difference.push_back((after[k] - 2.0 * middle[k] + before[k]) / (width * width));
  }
  return difference;
}

Flight ThroughEngine(const Departures& departures, const Trajectories& trajectories,
                     std::vector<double> own_speeds, double fps, int m, std::uint64_t seed) {
  std::vector<Id> ids;
  for (const Trajectory& trajectory : trajectories.trajectories) ids.push_back(trajectory.id);
  return [=, &departures, steps = m * departures.substeps()](const Window& window) {
    std::vector<std::vector<Vec3d>> flown;
    if (window.state.animal.empty()) return flown;
    std::vector<Id> there;
    std::vector<double> speeds;
    for (const int animal : window.state.animal) {
      there.push_back(ids[static_cast<std::size_t>(animal)]);
      speeds.push_back(own_speeds[static_cast<std::size_t>(animal)]);
    }
    Departure from = departures.At((window.middle - m - 1) / fps, there, window.state.position,
                                   window.state.velocity, speeds);
    try {
      for (int draw = 0; draw < kSeeds; ++draw) {
        from.world.seed = seed + static_cast<std::uint64_t>(draw);
        Engine engine(from.world, {from.swarm}, {.threads = 1, .kernel = {}});
        const auto on = [&] {
          for (int step = 0; step < steps; ++step) engine.Step();
          const FlockState state = engine.State();
          std::vector<Vec3d> position;
          for (const std::size_t k : from.place) position.push_back(state.position[k]);
          return position;
        };
        const std::vector<Vec3d> middle = on(), after = on();
        flown.push_back(SecondDifference(window.state.position, middle, after, m / fps));
      }
    } catch (const std::runtime_error&) {
      flown.clear();  // it flew apart
    }
    return flown;
  };
}

// From the scene's own start; each animal as the tetrahedron that it was nearest to before `split`.
Flight FromSceneStart(const FitOptions& options, const FitProblem& problem, const FitResult& fit,
                      const Trajectories& trajectories, double fps, int m, int split,
                      std::uint64_t seed, int threads) {
  struct Draw {
    std::vector<FramePositions> frames;
    std::vector<std::size_t> path;  // of each animal
  };
  const std::vector<FramePositions> frames = internal::FramesOf(trajectories);
  const internal::FlightStart start =
      internal::MakeFlightStart(options, problem, frames, trajectories, fps);
  const int first = SpanOf(trajectories).first;
  std::vector<Id> ids;
  for (const Trajectory& trajectory : trajectories.trajectories) ids.push_back(trajectory.id);
  std::vector<Draw> draws(kSeeds);
  ParallelFor(threads, 0, kSeeds, 1, [&](std::int64_t k, std::int64_t) {
    Draw& draw = draws[static_cast<std::size_t>(k)];
    auto flown =
        internal::Fly(start, fit.parameters.model, 1, seed + static_cast<std::uint64_t>(k));
    if (!flown) return;
    draw.frames = std::move(*flown);
    std::vector<FramePositions> seen;
    std::vector<std::vector<Vec3d>> there;
    const int step = std::max(1, (split - first) / kMatched);
    for (int f = 0; f < split - first; f += step) {
      seen.push_back(frames[static_cast<std::size_t>(f)]);
      there.push_back(draw.frames[static_cast<std::size_t>(f)].position);
    }
    draw.path = NearestPaths(ids, seen, there);
  });
  std::erase_if(draws, [](const Draw& draw) { return draw.frames.empty(); });
  return [=](const Window& window) {
    std::vector<std::vector<Vec3d>> flown;
    for (const Draw& draw : draws) {
      const auto middle = static_cast<std::size_t>(window.middle - first);
      const auto width = static_cast<std::size_t>(m);
      std::vector<Vec3d> at[3];
      for (const int animal : window.state.animal) {
        const std::size_t path = draw.path[static_cast<std::size_t>(animal)];
        for (std::size_t k = 0; k < 3; ++k) {
          at[k].push_back(draw.frames[middle + k * width - width].position[path]);
        }
      }
      flown.push_back(SecondDifference(at[0], at[1], at[2], m / fps));
    }
    return flown;
  };
}

// Along the field's mean, in steps of a frame by the midpoint rule.
Flight AlongField(const FitOptions& options, const FitProblem& problem, const FitResult& fit,
                  const ObservedFlock& flock, const Trajectories& early, double fps, int m) {
  const ModelSpec model = fit.parameters.model;
  const double scale = model.parameters.at("scale"), gain = model.parameters.at("gain");
  const double rest = fit.velocity_noise.value_or(0);
  const double r = std::clamp(gain * gain / std::max(rest * rest, 1e-300), 1e-3, 1e9);
  std::shared_ptr<ExpectedField> standing;
  if (!(model.parameters.at("evolution") > 0)) {
    FitOptions many = options;
    many.noise_animals = kFieldAnimals;
    const auto samples = internal::DriftSamples(many, problem, model, early, fps);
    standing = std::make_shared<ExpectedField>(samples.at(0), scale, r);
  }
  return [=, &options, &problem, &flock](const Window& window) {
    std::vector<std::vector<Vec3d>> flown;
    std::shared_ptr<ExpectedField> field = standing;
    if (!field) {
      const VelocitySample sample =
          Thinned(internal::DriftIn(options, problem, model, flock, window.middle - m - 3),
                  static_cast<std::size_t>(options.noise_animals));
      if (sample.size() == 0) return flown;
      field = std::make_shared<ExpectedField>(sample, scale, r);
    }
    const double cell = model.parameters.at("cell"), dt = 1 / fps;
    std::vector<std::vector<Vec3d>> path = {window.state.position};
    for (int frame = 0; frame < 2 * m; ++frame) {
      std::vector<Vec3d> half = path.back(), next = path.back();
      const std::vector<Vec3d> here = field->At(half);
      for (std::size_t k = 0; k < half.size(); ++k) half[k] += 0.5 * dt * here[k];
      const std::vector<Vec3d> there = field->At(half);
      for (std::size_t k = 0; k < next.size(); ++k) next[k] += dt * there[k];
      path.push_back(std::move(next));
    }
    std::vector<Vec3d> difference = SecondDifference(path[0], path[static_cast<std::size_t>(m)],
                                                     path[static_cast<std::size_t>(2 * m)], m * dt);
    for (std::size_t k = 0; k < difference.size(); ++k) {
      if (!internal::DriftsFreely(problem, cell, path[0][k])) difference[k] = {};
    }
    flown.push_back(std::move(difference));
    return flown;
  };
}

}  // namespace

SimulatedPrediction PredictBySimulation(const FitOptions& options, const FitProblem& given,
                                        const Trajectories& trajectories, double fps,
                                        std::uint64_t seed, int threads) {
  Check(options.held_out > 0, "a prediction needs time that is held out");
  const FitProblem problem = internal::InScene(given);
  const std::string why = problem.scene ? "" : WhyNoDeparture(problem.model);
  if (!why.empty()) {
    throw InputError(problem.model.where, 0,
                     "model " + problem.model.name + " cannot be flown from trajectories: " + why,
                     "leave it out, or give its scene: --scene SCENE.toml");
  }
  const int split = FirstHeldOut(trajectories, options.held_out);
  const Trajectories early = BeforeFrame(trajectories, split);
  SimulatedPrediction prediction;
  prediction.fit = FitModel(options, problem, early, fps, seed, threads);
  if (!prediction.fit.IsUsable()) return prediction;
  const ObservedFlock flock(trajectories, fps, options.bridged_gap);
  const int m = options.window > 0 ? options.window : ChooseWindow(flock, options.longest_window);
  std::optional<Departures> departures;
  Flight fly;
  if (problem.model.name == "swarm") {
    fly = AlongField(options, problem, prediction.fit, flock, early, fps, m);
  } else if (DepartsFromSceneStart(problem.model)) {
    fly = FromSceneStart(options, problem, prediction.fit, trajectories, fps, m, split, seed,
                         threads);
  } else {
    departures.emplace(problem.scene, prediction.fit.parameters, early, fps, options.substeps);
    fly = ThroughEngine(*departures, trajectories,
                        OwnSpeeds(trajectories, fps, split, prediction.fit.own_speed_mean), fps, m,
                        seed);
  }
  const Scorer scorer(flock, m, threads);
  const Sums before = scorer.Score(flock.span().first, split - 1, fly);
  const Sums after = scorer.Score(split, flock.span().last, fly);
  if (after.rows < kFewestRows || !(before.predicted > 0) || !(after.observed > 0)) {
    return prediction;
  }
  const double b = before.product / before.predicted;
  prediction.r2 = (2 * b * after.product - b * b * after.predicted) / after.observed;
  return prediction;
}

}  // namespace flocklift
