// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Depth by one solve over the whole sequence: the path of every animal and the flock's few unknowns
// that best explain rays, sizes and what is known of flight (batch_problem.h), by Gauss-Newton with
// Levenberg's damping per animal, from a search on a grid (depth_search.h). Spreads of the priors
// are re-estimated between solves by marginal likelihood (spread_estimator.h).
// Sequences longer than a window are solved window by window (windows.h), from the one where most
// is known outwards; each hands on what it has found of the flock's unknowns. Linear in frames;
// parallel over animals; the same at any number of threads.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_BATCH_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_BATCH_H_

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "reconstruct/initialize/segments.h"
#include "reconstruct/knowledge.h"
#include "reconstruct/solve/batch_options.h"
#include "reconstruct/solve/dynamics_report.h"
#include "reconstruct/solve/solved_path.h"
#include "simulate/core/progress.h"

namespace flocklift {

namespace internal {
struct WindowToRefine;  // window_solver.h

// A method that goes on from the batch solution of every window.
struct Refinement {
  std::function<void(const WindowToRefine&)> refine;
  std::uint64_t fingerprint = 0;  // of the method and its options (fingerprint.h)
  int iterations = 0;             // of solvers that it takes, about
};
}  // namespace internal

// How well one kind of residual is met at the solution, in units of its sd.
struct TermStatistics {
  std::string name;
  long count = 0;
  double rms = 0;
  double outliers = 0;  // share beyond three sds
};

struct BatchReport {
  double initial_cost = 0, final_cost = 0;
  int iterations = 0;
  bool converged = false;
  double scale_sd = 0;            // relative sd of the common scale
  Uncertain flock_speed;          // posterior [m/s]
  Uncertain size_ratio;           // posterior, relative to the wingspan's prior
  Uncertain lean;                 // into turns (cost_functions/size.h), posterior
  Uncertain speed_against_size;   // log of (speed by the sizes over its prior's mean); sizes' sd
  bool erratic = false;           // animals were taken to keep no speed (erratic_flight.h)
  double stiff_boxes = 0;         // probability that boxes do not follow the bodies in them
                                  // (size_model.h); 0 where no wingspan is known
  bool weak_perspective = false;  // forms showed bodies in weak perspective (body_fit.h)
  std::vector<std::pair<std::string, double>> spreads;  // estimated
  std::vector<TermStatistics> terms;
  DynamicsReport dynamics;  // where forces were tried (dynamics.h)
};

struct BatchResult {
  std::vector<SolvedPath> paths;  // as the segments
  BatchReport report;
};

// Anchors and up_in_cam of `knowledge` are in the axes of the reference camera. Every sighting gets
// a finite point, however little is known of it. A long sequence keeps the windows it has solved in
// the file `checkpoint` (empty: nowhere) until it is done: a killed run goes on to the same bytes.
BatchResult SolveBatch(const BatchOptions& options, const Knowledge& knowledge,
                       const Segments& segments, double fps, int threads, const Progress& progress,
                       const std::filesystem::path& checkpoint = {},
                       const internal::Refinement& refinement = {});

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_BATCH_H_
