// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Expectation maximisation of the priors' spreads. With errors e of a process at the solution and
// their posterior variances v, the next standard deviation is
//   sd^2 = (n mean(e^2 + v) + n_0 sd_0^2) / (n + n_0)
// where n counts animals (tracks of less than a second as parts of one) and the first guess sd_0 is
// worth n_0 of them. (Dempster, Laird and Rubin, 1977; inverse-gamma prior.) How long an error of
// size lasts is found alike, from its correlation from knot to knot, with the first guess's rho_0:
//   rho = (n sum(e e') / sum((e^2 + e'^2) / 2) + n_0 rho_0) / (n + n_0),  sums in expectation.

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
  double animals_ = 0;
  std::array<double, kTermCount> squares_{}, counts_{};
  double sums_ = 0, differences_ = 0;  // of pairs of sizes, squared
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_SPREAD_ESTIMATOR_H_
