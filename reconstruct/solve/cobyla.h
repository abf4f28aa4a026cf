// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Depth frame by frame as published: Algorithm 3 of Lin, "Flock motion from two-dimensional
// projection" (2019). Unknown are the depths d_n of all N animals in frame f, given the solved
// frames f-1 and f-2; p_n = ray_n d_n, near <= d_n <= far, v_n^f = p_n^f - p_n^{f-1}.
//   second frame   sum_n | |v_n^f| - speed / fps |
//   later frames   sum_n lambda_t | |v_n^f| - |v_n^{f-1}| | + lambda_f |p_n^f - target_n|
//   target_n = p_n^{f-1} + lambda_sep s_n + (1 - lambda_sep) c_n     (simulate/forces/lin.h)
// minimised by NLopt's COBYLA over the N-vector of depths, from those of the frame before. s and c
// are of frame f-1 (the sum then separates over animals) or of frame f (it does not).
//
// She assumes that all animals are there all the time, and assigns the first frame's positions.
// Here an animal's first frame is assigned, whenever it enters: at the middle of the range in the
// sequence's first frame (or by a file), later at the mean depth of the animals that are solved in
// the frame before. Its second frame asks for the speed, and from its third on it is one of the
// flock. After a gap it enters again, at its last depth.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_COBYLA_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_COBYLA_H_

#include <map>
#include <vector>

#include "reconstruct/initialize/segments.h"
#include "reconstruct/solve/solved_path.h"
#include "simulate/core/progress.h"

namespace flocklift {

struct CobylaOptions {
  double lambda_t = 1;
  double lambda_f = 0.1;
  double lambda_sep = 0.5;
  double lambda_speed = 0;
  double near = 0;
  double far = 0;
  double d_sep = 2;
  double separation_exponent = 0;
  bool current_frame = false;
  double tolerance = 1e-4;
  int max_evaluations = 5000;
};

template <typename Visitor>
void Describe(Visitor& visit, CobylaOptions& o) {
  visit("lambda-t", o.lambda_t, {.low = 0, .high = 1e6}, "", "weight of trajectory smoothness");
  visit("lambda-f", o.lambda_f, {.low = 0, .high = 1e6}, "", "weight of flock behaviour");
  visit("lambda-sep", o.lambda_sep, {.low = 0, .high = 1}, "",
        "weight of separation, against cohesion");
  visit("lambda-speed", o.lambda_speed, {.low = 0, .high = 1000}, "m/s",
        "speed of the first displacement (0: --speed, or a guess from the other priors)");
  visit("d-near", o.near, {.low = 0, .high = 1e6}, "m",
        "least depth (0: --near, or a guess from the other priors)");
  visit("d-far", o.far, {.low = 0, .high = 1e6}, "m",
        "largest depth (0: --far, or a guess from the other priors)");
  visit("d-sep", o.d_sep, {.low = 0, .high = 1e6}, "m", "animals nearer than this separate");
  visit("separation-exponent", o.separation_exponent, {.low = 0, .high = 4}, "",
        "0: unit offsets (Algorithm 1); 1: weighted by 1/r (the text)");
  visit("current-frame", o.current_frame, {}, "",
        "neighbours of the frame being solved instead of the one before");
  visit("tolerance", o.tolerance, {.low = 1e-12, .high = 0.1}, "",
        "relative change of the depths at which COBYLA stops");
  visit("max-evaluations", o.max_evaluations, {.low = 1, .high = 1e7}, "",
        "of the objective in one frame, at most");
}

struct CobylaReport {
  double final_cost = 0;  // sum of the frames' minima
  int frames = 0;         // solved by optimisation
  int exhausted = 0;      // of those, stopped before the optimiser was done
};

struct CobylaResult {
  std::vector<SolvedPath> paths;  // as the segments; sd_log_depth 0: the method does not know it
  CobylaReport report;
};

// Depths of the first frame that somebody assigns, by id [m]; others start at mid-range.
using FirstDepths = std::map<Id, double>;

// The published optimiser, or Levenberg and Marquardt on the same objective (lin_ceres.cc): what
// the optimiser alone changes.
enum class LinOptimizer { kCobyla, kCeres };

CobylaResult SolveCobyla(const CobylaOptions& options, const FirstDepths& first_depths,
                         const Segments& segments, double fps, const Progress& progress,
                         LinOptimizer optimizer = LinOptimizer::kCobyla);

namespace internal {

// One animal in the frame being solved: its ray, and what is solved of it.
struct LinAnimal {
  Vec3d ray;                // (x/z, y/z, 1)
  int solved_frames = 0;    // 1: only `last`; 2 and more: `before_last` too
  Vec3d last, before_last;  // positions in frames f-1, f-2 [m]
};

// The objective at the given depths.
double LinObjective(const CobylaOptions& options, double fps, const std::vector<LinAnimal>& animals,
                    const std::vector<double>& depths);

}  // namespace internal
}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_COBYLA_H_
