// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The priors' spreads by marginal likelihood. With errors e of a process at the solution and their
// posterior variances v under the present sd s, the next standard deviation is
//   sd^2 = (n mean(e^2) + n_0 sd_0^2) / (n (1 - mean(v) / s^2) + n_0)
// where n counts animals (tracks of less than a second as parts of one) and the first guess sd_0 is
// worth n_0 of them; of sizes, whose errors last a time t that is short, it counts one in 2 t
// instead, or one a knot. It is MacKay's fixed point (Bayesian interpolation, 1992), that of
// expectation maximisation, which takes (n mean(e^2 + v) + n_0 sd_0^2) / (n + n_0) and creeps where
// little is seen of an error (v near s^2). How long an error of size lasts is found by expectation
// maximisation, from its correlation from knot to knot, with the first guess's rho_0:
//   rho = (n sum(e e') / sum((e^2 + e'^2) / 2) + n_0 rho_0) / (n + n_0),  sums in expectation.
// Sizes differ between animals as their wingspans do and by what pose leaves over: never by less
// than the wingspan's stated sd, and more is found only where speeds are known too. (Else a flock
// of one depth whose sizes differ much is as good as a deep one.)

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_SPREAD_ESTIMATOR_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_SPREAD_ESTIMATOR_H_

#include <array>

#include "reconstruct/solve/batch_problem.h"

namespace flocklift::internal {

// Sum and difference of the errors of two neighbouring knots.
struct ErrorPair {
  ResidualRow sum, difference;

  // Rows of one path as ForEachError gives them, `b` of the knot after that of `a`.
  ErrorPair(const ResidualRow& a, const ResidualRow& b);
};

class SpreadEstimator {
 public:
  explicit SpreadEstimator(const Spreads& now) : now_(now) {}  // what the errors were found with

  void BeginAnimal(double duration);
  void Add(Term term, double error, double variance);
  // Of an ErrorPair of sizes.
  void AddSizePair(double sum, double sum_variance, double difference, double difference_variance);
  void Merge(const SpreadEstimator& other);
  void Update(const Spreads& guess, double knot_interval, Spreads* spreads) const;

 private:
  double SdOf(Term term) const;

  Spreads now_;
  double animals_ = 0, seconds_ = 0;
  std::array<double, kTermCount> squares_{}, variances_{}, counts_{};
  double sums_ = 0, differences_ = 0;  // of pairs of sizes, squared
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_SPREAD_ESTIMATOR_H_
