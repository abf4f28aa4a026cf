// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Weights and noise correlation from motion rows: first the regression with instruments for an
// error without memory; where what it leaves over has one (its correlation at lag 2m + 3 frames,
// beyond every common window, is five standard errors from 0), Gauss-Newton steps of
// whitened_rows.h.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_WHITENED_FIT_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_WHITENED_FIT_H_

#include <optional>
#include <vector>

#include "reconstruct/fit/lagged_regression.h"
#include "reconstruct/fit/whitened_rows.h"

namespace flocklift {

struct WhitenedFit {
  RegressionResult regression;  // of the p weights: estimate, sd, correlation
  std::optional<double> rho;    // correlation of u over m frames, when it has a memory
  bool converged = true;
  // How much more the variance along the line of sight grows with that of depth [1/m^2], for
  // WhiteningOptions::depth_variance; 0 without lines of sight.
  double depth_variance = 0;

  bool IsUsable() const { return regression.IsUsable(); }
};

WhitenedFit SolveWhitened(const WhiteningOptions& options, const MotionRows& rows);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_WHITENED_FIT_H_
