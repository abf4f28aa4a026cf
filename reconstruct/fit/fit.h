// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What made a flock move: the parameters of a model's force terms, from positions alone.
//   acceleration = sum_p theta_p f_p(state) + what is known + c_i v/|v| + u
// f_p by the simulator's own templated terms. Estimators:
//   state-space          states, parameters, process and position noise together, of greatest
//                        marginal likelihood (state_space.h); for smooth models, the default there
//                        unless the input states depth errors. Named there, it makes unknowns of
//                        them; where these times the positions are more than 3e6, by regression
//   errors-in-variables  accelerations as second differences with the terms averaged under the same
//                        window (motion_rows.h). Taking both from the same frames biases least
//                        squares towards 0 without end, so the moments use instruments from earlier
//                        frames, and what the model leaves over may last (whitened_rows.h).
//                        Standard errors allow errors in common between animals and autocorrelation
//                        (lagged_regression.h)
//   differences          least squares on differences of the same frames, for comparison only: on
//                        the reference flock (equations.md 2b) it misses 93 to 98 % of the weights,
//                        however long the data, so it is never chosen unless named
// and one for what has no accelerations, the drift of the model swarm:
//   noise-field          scale and gain of its curl noise, the seed unknown, of greatest marginal
//                        likelihood (noise_field.h)
// and for models without usable derivatives, such as bswarm:
//   statistics           simulations whose speeds, accelerations, turning rates, distances and
//                        polarisation are as the data's (simulated_fit.h); shape, morph and crowd
//                        need the scene that says what they fly to
// The force terms that a scene adds are fitted with the model that they add to, by these estimators
// (scene_terms.h), by statistics where they feel more than the state and what stands still.
// A goal may move: only what it does to animals apart from each other is used, and its mean place
// is estimated. A state-space estimate frees radii and tapers too; elsewhere they are given. World
// frame, z up; metres, seconds.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_FIT_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_FIT_H_

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "reconstruct/fit/simulated_fit.h"
#include "simulate/camera/camera.h"
#include "simulate/core/parameters.h"
#include "simulate/core/progress.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

struct FitOptions {
  int window = 0;               // m of motion_rows.h [frames]; 0: chosen from the data
  double longest_window = 0.5;  // when it is chosen [s]
  int substeps = 4;             // steps a frame of the engine that the weights are for; 0: infinite
  int bridged_gap = 5;          // missing frames that neighbours are interpolated over
  double held_out = 0.2;        // share of the time, at its end, that the prediction is scored on
  int max_rows = 100000;        // more animals and frames are thinned to every n-th frame
  int depth_draws = 6;          // refits with depth errors added, when the input states them
  double depth_error_time = 2;  // for how long a depth error lasts [s]
  double scale_sd = 0;          // relative sd of the common scale in sd_depth
  int noise_animals = 400;      // of curl noise: animals of a field that it is sought from
  double statistics_time = 4;   // of simulated statistics: length of a simulation [s]; 0: all
  int global_evaluations = 600;  // of simulated statistics, at most
  int local_evaluations = 250;
  double search_range = 5;  // parameters are sought within this factor of their start
  double known_within = 0;  // share of itself that 3 sd of a parameter called known may be; 0: any
};

template <typename Visitor>
void Describe(Visitor& visit, FitOptions& o) {
  visit("window", o.window, {.low = 0, .high = 10000}, "frames",
        "half width of the window accelerations are taken over; 0: chosen from the positions' "
        "noise, of a reconstruction by how the model then flies");
  visit("longest-window", o.longest_window, {.low = 0}, "s", "longest window that is chosen");
  visit("substeps", o.substeps, {.low = 0, .high = 1000}, "",
        "steps a frame of the engine that the weights are for; 0: continuous time");
  visit("bridged-gap", o.bridged_gap, {.low = 0, .high = 1000}, "frames",
        "gaps of up to so many frames are interpolated for the neighbours' sake");
  visit("held-out", o.held_out, {.low = 0, .high = 0.9}, "",
        "share of the time, at its end, that the prediction is scored on");
  visit("max-rows", o.max_rows, {.low = 100}, "",
        "more animals and frames than this are thinned to every n-th frame");
  visit("depth-draws", o.depth_draws, {.low = 0, .high = 1000}, "",
        "refits with depth errors added, when the input states them");
  visit("depth-error-time", o.depth_error_time, {.low = 1e-3}, "s",
        "for how long a depth error lasts");
  visit("scale-sd", o.scale_sd, {.low = 0, .high = 10}, "",
        "relative sd of the common scale, which sd_depth includes");
  visit("noise-animals", o.noise_animals, {.low = 50, .high = 2000}, "",
        "of curl noise: animals that it is sought from, in each time of a noise that evolves");
  visit("statistics-time", o.statistics_time, {.low = 0}, "s",
        "of simulated statistics: length of a simulation; 0: as long as the data");
  visit("global-evaluations", o.global_evaluations, {.low = 1, .high = 1000000}, "",
        "of simulated statistics: parameters tried far and wide");
  visit("local-evaluations", o.local_evaluations, {.low = 1, .high = 1000000}, "",
        "likewise: parameters tried near the best of those");
  visit("search-range", o.search_range, {.low = 1.01, .high = 1e3}, "",
        "likewise: parameters are sought within this factor of where they start; of less than 1.35 "
        "nothing is known, since all ends near a bound");
  visit("known-within", o.known_within, {.low = 0, .high = 1}, "",
        "a parameter of which 3 standard deviations are more than this share of it is flagged as "
        "not determined too; 0: a weight's sign and its size to a quarter of all forces will do");
}

// A point that attracts all animals, besides the model's own terms (a scene's [[goal]]).
enum class GoalChoice {
  kNone,
  kWhenHeld,  // sought when, without it, something holds the animals in place
  kSought,
  kGiven,
};

enum class FitMethod {
  kAuto,  // state-space for smooth models, without depth errors; else errors-in-variables
  kStateSpace,
  kErrorsInVariables,
  kDifferences,
  kNoiseField,  // of the model swarm, and of no other
  kStatistics,  // of any model but swarm; the default where the others do not know the model
};
std::string NameOf(FitMethod method);  // as in the list above
// Throws std::invalid_argument for another name.
FitMethod FitMethodOf(const std::string& name);
SimulatedSearch SimulatedSearchOf(const std::string& name);  // likewise: bobyqa, crs, isres

// What to fit: the model with values for all that is not free (defaults where it says nothing).
struct FitProblem {
  ModelSpec model;
  std::vector<std::string> free;  // empty: every weight that the data can speak of; names as in
                                  // simulate/core/model_terms.h
  FitMethod method = FitMethod::kAuto;
  SimulatedSearch search = SimulatedSearch::kCrs;  // of simulated statistics
  std::optional<Region> walls;  // the box of the boundary term; without it the term is left out
  GoalChoice goal = GoalChoice::kWhenHeld;
  Vec3d goal_position;           // when given [m]
  double goal_reach = 0;         // likewise: animals nearer than this are there [m]
  std::optional<Camera> camera;  // where depth errors point; absent: eye at the world's origin
  std::optional<Scene> scene;    // what surrounds the animals; its forces are the model's terms
};

struct FittedWeight {
  std::string name;
  double value = 0;         // as written: ProbableWeights of fit_measures.h, never below 0
  double estimate = 0;      // free of that
  double sd = 0;            // of the estimate; infinite when nothing is known
  bool determined = false;  // do the data say anything about it?
  double plain = 0;         // least squares on differences, biased, for comparison
  // Factor by which another depth error of the stated size changes the estimate, and its sd.
  std::optional<double> depth_factor, depth_factor_sd;
  // Share of the term's mean square that such an error changes: near 0 the term is seen, near 1 or
  // above what it was computed from is noise, and the factor says nothing.
  std::optional<double> depth_share;
};

// A parameter that was held at its value, and how far the motion speaks against that: N(0, 1) where
// the value is right and the model is the truth; 0 where the parameter does not act.
struct HeldTest {
  std::string name;
  double value = 0, z = 0;
};

// An eigenvector of the weights' covariance, each weight in units of the term's share of the
// acceleration; `sd` [m/s^2].
struct FitDirection {
  std::vector<double> weights;
  double sd = 0;
};

enum class FitStatus {
  kOk,
  kTooFewAnimals,  // no animal
  kTooFewFrames,   // runs of frames are too short for the window
  kTooFewRows,     // too few equations for the number of weights
};
std::string StatusText(FitStatus status);

struct FitResult {
  FitStatus status = FitStatus::kOk;
  Parameters parameters;              // the model, the posterior over its weights, goal, walls
  std::vector<FittedWeight> weights;  // in the order of posterior.free; last the goal's, if any
  int animals = 0, frames = 0;
  std::int64_t rows = 0;          // animals times frames used
  std::int64_t rows_clamped = 0;  // of these, whose speed limit acted
  std::int64_t rows_mixed = 0;    // left out: it acted in part of the window
  bool converged = true;          // could the memory of what is left over be estimated?
  FitMethod method = FitMethod::kErrorsInVariables;  // that was used
  int window = 0;                                    // m [frames]
  double acceleration_sd = 0;                        // without the model: constant velocity [m/s^2]
  double residual_sd = 0;                            // with it
  double r2 = 0;                                     // share explained, in sample
  std::optional<double> r2_held_out;   // of accelerations after the fit's time, from earlier states
  double noise_sd = 0;                 // of what is not explained and lasts [m/s^2]
  double noise_time = 0;               // its correlation time [s]; 0: fresh at every step
  double diffusion = 0;                // of the velocity, when noise_time is 0 [m^2/s^3]
  std::optional<double> diffusion_sd;  // of a state-space estimate
  std::optional<double> position_noise;  // sd of each coordinate, likewise [m]
  // Of simulated statistics: by name, distance from the data's in sd from seed to seed.
  std::vector<std::pair<std::string, double>> misfit;
  std::optional<double> velocity_noise;         // of what drifts: sd not explained [m/s]
  double own_speed_mean = 0, own_speed_sd = 0;  // the animals' cruising speeds, if any [m/s]
  double condition = 0;                         // of the moment matrix, terms scaled to unit rms
  FitDirection best, worst;
  std::vector<HeldTest> held;         // of what is not free, where that can be told
  std::vector<std::string> warnings;  // one sentence each

  bool IsUsable() const { return status == FitStatus::kOk; }
};

// Deterministic in options, problem, data and seed, at any number of threads. Throws InputError for
// a model or weight that does not exist, std::invalid_argument for options out of range.
FitResult FitModel(const FitOptions& options, const FitProblem& problem,
                   const Trajectories& trajectories, double fps, std::uint64_t seed, int threads,
                   const Progress& progress = {});

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_FIT_H_
