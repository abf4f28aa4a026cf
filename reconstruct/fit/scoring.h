// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One state-space estimate in the making (state_space.h): the scoring itself (scoring.cc), and what
// unknown depth errors add to it (scoring_depth.cc). Those, z of depth_paths.h, are integrated over
// by Laplace's method: with H their information where they are likeliest, what is maximised is
//   log p(y, z | phi) - log det H(phi) / 2
// They alone would be taken too large and with them the parameters, by 20 % of the reference
// flock's where errors are a fifth of its size.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_SCORING_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_SCORING_H_

#include <Eigen/Core>
#include <vector>

#include "reconstruct/fit/state_space.h"

namespace flocklift::internal {

// phi = (theta, log q, log(s^2 + s0^2), z of depth errors).
class Scoring {
 public:
  // `paths` may be null.
  Scoring(const StateSpaceOptions& options, const ProcessModel& model,
          const std::vector<double>& start, const FilterInput& input, const DepthPaths* paths);

  StateSpaceFit Run();
  // At `start` and the fit's noise and depth errors: of the parameters from `first_held` on.
  std::vector<HeldScore> Score(const StateSpaceFit& fit, std::size_t first_held);

 private:
  FlockNoise NoiseAt(const std::vector<double>& phi) const;
  FilterSweep SweepAt(const std::vector<double>& phi, FilterSweep memory = {}) const;
  // Where the innovations are far smaller than their covariances, both noises shrink together until
  // they are not: of a common factor the likeliest is known, while steps of a logarithm are of 1.
  void Shrink(FilterSweep* sweep);
  // Score and information at phi_.
  void Linearize(const FilterSweep& base);
  // Adds to them what is expected of depth errors, and half the gradient of log det H, by
  // Hutchinson's (1990) estimate of tr(H^-1 H_p).
  void AddDepthErrors(const FilterSweep& base);
  // With depth errors the information that was observed takes the place of what was to be expected,
  // which knows nothing of log det H: by differences of the score. Kept as it was where the data
  // are too few for that.
  void ObserveInformation();
  // -I^-1 g over what the data speak of; s^2 at 0 that wants to fall further has no part.
  Eigen::VectorXd Step();
  std::vector<Eigen::Index> Used() const;
  // In units of the sd; depth errors are none of what is asked for.
  double Largest(const Eigen::VectorXd& step) const;
  // Along the step, halved until the cost falls; false when it never does.
  bool Walk(const Eigen::VectorXd& step, FilterSweep* sweep);
  void Describe(const FilterSweep& sweep, StateSpaceFit* fit) const;

  const StateSpaceOptions& options_;
  const ProcessModel& model_;
  const FilterInput& input_;
  const DepthPaths* paths_;  // or null
  std::size_t p_;            // parameters; phi begins with `own_`: these and the noises
  std::size_t own_;
  std::vector<double> phi_, differences_;
  double smallest_ = 0, lowest_ = 0;  // s0^2 and its logarithm
  double lowest_q_ = 0;               // log q, likewise, far below what rounding makes
  std::vector<bool> free_;
  Eigen::VectorXd score_, determinant_;
  Eigen::MatrixXd information_, covariance_;

  // Of one linearisation; kept, since fresh pages of memory cost more than what is written there.
  std::vector<FilterSweep> moved_;  // where one of the own unknowns is
  std::vector<Eigen::Matrix3d> roots_;
  Eigen::VectorXd white_;
  Eigen::MatrixXd slopes_, changes_;  // whitened eps_p, and S_p of what S depends on
  FilterSweep spare_;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_SCORING_H_
