// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The solve of one window of a sequence: the path of every animal and the flock's few unknowns
// (batch_problem.h) by Gauss-Newton with Levenberg's damping per animal, the spreads of the priors
// re-estimated between solves (spread_estimator.h).

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_WINDOW_SOLVER_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_WINDOW_SOLVER_H_

#include <functional>
#include <optional>
#include <vector>

#include "reconstruct/initialize/segments.h"
#include "reconstruct/knowledge.h"
#include "reconstruct/solve/batch.h"
#include "reconstruct/solve/batch_options.h"
#include "reconstruct/solve/batch_problem.h"
#include "reconstruct/solve/batch_solver.h"

namespace flocklift::internal {

inline constexpr int kStartIterations = 15;                     // before the first round, at most
inline constexpr int kSpreadRounds = 8, kSpreadIterations = 6;  // of each, at most
// After these rounds depths are searched anew: with spreads roughly known, and well known.
inline constexpr int kFirstSearch = 1, kSecondSearch = 5;

struct SolvedWindow {
  BatchResult result;
  Belief belief;  // in the flock's first four unknowns, that of other windows included
};

// How well depths are known but for the common scale, by another method that counts for `weight`:
// its share of the variance of the log depth at every sighting, by segment.
struct DepthPosterior {
  double weight = 0;
  std::vector<std::vector<double>> variances;
};

// A window when the batch method is done with it, for a method that goes on from there and leaves
// its own paths, their posterior where that is not the batch method's, and its report.
struct WindowToRefine {
  const Segments& segments;
  BatchState& state;
  std::optional<DepthPosterior>* posterior = nullptr;
  // How sure the batch method is itself: variances of the log depth at every sighting, by segment,
  // that of the common scale taken out.
  std::function<std::vector<std::vector<double>>()> variances;
  DynamicsReport* report = nullptr;
};
using WindowRefiner = std::function<void(const WindowToRefine&)>;

// `belief`: what other windows said. `first_frame` is the frame at time 0 of the segments.
SolvedWindow SolveWindow(const BatchOptions& options, const Knowledge& knowledge,
                         const Segments& segments, const std::optional<Belief>& belief,
                         int first_frame, double fps, int threads,
                         const std::function<void()>& on_iteration,
                         const WindowRefiner& refine = {});

// The batch solution for other sightings of the same animals, their first and last among them,
// with the spreads and from the depths of a solution: far cheaper than from nothing.
// Its birds point into `segments`.
BatchState SolveAgain(const BatchState& solved, const Segments& segments, int max_iterations,
                      int threads);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_WINDOW_SOLVER_H_
