// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Linear regression with instruments from the past, for equations of motion
//   y_e = sum_p features_ep theta_p + u_e.
// Positions that carry noise, and process noise that moves the velocity inside the very window that
// the acceleration is taken from, correlate features with the error u: least squares is biased
// then, however long the data. Instruments computed from strictly earlier frames correlate with the
// features and not with u, so
//   sum_e w_e instruments_e u_e = 0
// (two-stage least squares, just identified) is consistent. With instruments = features it is
// ordinary weighted least squares.
//
// Standard errors allow errors of any correlation between animals of one frame and of any
// autocorrelation that dies out, or else of any that belongs to an animal for ever; the larger of
// two is given. First, the scores are summed over each frame and their long-run
// covariance is estimated with nu equal-weighted cosines, with intervals of Student's t_nu
// (Driscoll and Kraay 1998 for the sums; Lazarus, Lewis, Stock and Watson, "HAR inference:
// recommendations for practice", 2018, for the cosines and nu = 0.4 T^(2/3)). The sd given is
// widened by t_nu(0.975) / 1.96, so that estimate +- 1.96 sd is the 95 % interval.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_LAGGED_REGRESSION_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_LAGGED_REGRESSION_H_

#include <cstddef>
#include <vector>

namespace flocklift {

// E scalar equations with p terms, by increasing time.
struct RegressionRows {
  int terms = 0;                    // p
  std::vector<double> response;     // E
  std::vector<double> features;     // E x p
  std::vector<double> instruments;  // E x p
  std::vector<double> weight;       // E
  std::vector<int> time;            // E: frame counter, non-negative
  std::vector<int> group;           // E: which animal, non-negative

  std::size_t size() const { return response.size(); }
};

enum class RegressionStatus {
  kOk,
  kTooFewRows,   // fewer than 10 equations a term
  kTooFewTimes,  // the frames used span fewer than kMinTimes
};
inline constexpr int kMinTimes = 12;
inline constexpr int kMinGroups = 8;

struct RegressionResult {
  RegressionStatus status = RegressionStatus::kOk;
  std::vector<double> estimate;     // p; 0 where the data say nothing
  std::vector<double> sd;           // p; infinite where the data say nothing
  std::vector<double> correlation;  // p x p, row-major
  std::vector<double> feature_rms;  // p
  // Of the moment matrix, its terms scaled to unit rms; infinite when singular.
  double condition = 0;
  double residual_sd = 0;  // weighted rms of u
  int cosines = 0;         // nu

  bool IsUsable() const { return status == RegressionStatus::kOk; }
};

RegressionResult SolveRegression(const RegressionRows& rows);

// The 0.975 quantile of Student's t with nu >= 4 degrees of freedom, to 0.3 %.
double StudentQuantile975(int nu);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_LAGGED_REGRESSION_H_
