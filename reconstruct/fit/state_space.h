// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Parameters, process noise and position noise together, of greatest marginal likelihood, the
// states integrated out (flock_filter.h), by Fisher scoring (Gupta and Mehra 1974): with
// phi = (theta, log q, log(s^2 + s0^2)), innovations eps and covariances S,
//   score  g_p  = sum  eps' S^-1 eps_p + tr(S^-1 S_p) / 2 - eps' S^-1 S_p S^-1 eps / 2
//   information I_pr = sum  eps_p' S^-1 eps_r + tr(S^-1 S_p S^-1 S_r) / 2
// eps_p, S_p derivatives by differences of whole sweeps, which see the gain's change too. The sd
// are those of I^-1. Of innovations that know of a speed limit, which are no Gaussian's, the first
// term alone is taken, from means that are right (quasi-likelihood: Wedderburn 1974). Where s^2
// goes to 0, or q far below what rounding makes, it stays there and is no unknown any more. Boids
// that nothing disturbs are known to 1e-6 so: of 12 flocks (50 over 10 s, 20 over 4 s) 72
// parameters, all within 2 of the sd that fit.cc states, which is no less than what rounding makes
// of a number. From far above a step of -1 in the logarithm of q is all that the scoring knows,
// however much is too much; both noises then shrink together, by the factor that is likeliest.
//
// For a flock that has forgotten its start, I of a drag gamma is (animals - 1) 3 T / (2 gamma), as
// of a damped velocity that is known without error (of the reference flock, gamma = 20 alignment,
// 2.4 %): no time is lost by having positions only. Over 516 seeds of that flock the errors are
// 1.03 times the sd, and 95 % intervals cover 95.2 % (cohesion) and 93.2 % (alignment); over 200 of
// them between 90 and 95 %, by chance, and least squares on the true velocities no less.
//
// Depth errors of a reconstruction, where the input states them, are unknowns too (depth_paths.h)
// and integrated over (scoring.h). Of 8 animals of the reference flock over 600 frames, 20 m away
// with errors of 0.2 m that last 2 s (1 s), an estimate that does not know of them is 40 % (60 %)
// low and its intervals cover 6 % (none); with them, over 60 seeds, 5 % (1 %) low, and they cover
// 91 % (98 %); of errors of 0.4 m 9 % low, covering 90 %.
//
// Of 50 boids with tapers over 300 frames, four weights and two radii free, what least squares on
// the true states of every step reaches (over 500 seeds errors of 1.00 to 1.03 sd, 9 of 3000 more
// than 3) is reached: the two agree in what a seed is off by.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_STATE_SPACE_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_STATE_SPACE_H_

#include <span>
#include <vector>

#include "reconstruct/fit/depth_paths.h"
#include "reconstruct/fit/flock_filter.h"

namespace flocklift {

struct StateSpaceOptions {
  FilterOptions filter;
  int rounds = 30;         // of scoring, at most
  double accuracy = 0.01;  // it ends when no unknown moves by more of its sd
  int threads = 1;
};

enum class StateSpaceStatus {
  kOk,
  kTooFew,        // fewer than ten innovations an unknown
  kNotConverged,  // the estimate is of the last round
};

struct StateSpaceFit {
  StateSpaceStatus status = StateSpaceStatus::kOk;
  std::vector<double> estimate;     // p
  std::vector<double> sd;           // p; infinite where the data say nothing
  std::vector<double> correlation;  // p x p, row-major
  FlockNoise noise;
  double diffusion_sd = 0;           // of noise.diffusion
  double position_variance_sd = 0;   // of noise.position_variance; 0 when it stayed at 0
  std::vector<double> depth_errors;  // z of the depth paths, if any
  double cost = 0;                   // -2 log likelihood, without its constant
  std::size_t innovations = 0;       // three equations each
  int rounds = 0;

  bool IsUsable() const { return status != StateSpaceStatus::kTooFew; }
};

// Starts from `start` (p values). Depth errors, where there are paths of them, are estimated too.
// The same at any number of threads.
StateSpaceFit FitStateSpace(const StateSpaceOptions& options, const ProcessModel& model,
                            const std::vector<double>& start, const FilterInput& input,
                            const DepthPaths* paths = nullptr);

// What the likelihood says of a parameter that a fit held at its value.
struct HeldScore {
  double z = 0;       // its score in sd (Rao 1948): N(0, 1) where the value is right; 0: unfelt
  double change = 0;  // that it asks for, to first order
};

// Of the last parameters of `model`, held at `held`, where all others, noise included, are at
// `fit`'s estimates, which were made with these values: what they would gain by moving too.
std::vector<HeldScore> ScoreHeld(const StateSpaceOptions& options, const ProcessModel& model,
                                 const StateSpaceFit& fit, std::span<const double> held,
                                 const FilterInput& input, const DepthPaths* paths = nullptr);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_STATE_SPACE_H_
