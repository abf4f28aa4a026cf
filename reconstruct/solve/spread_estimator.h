// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Expectation maximisation of the priors' spreads. With errors e of a process at the solution and
// their posterior variances v, the next standard deviation is
//   sd^2 = (n mean(e^2 + v) + n_0 sd_0^2) / (n + n_0)
// where n counts animals (tracks of less than a second as parts of one) and the first guess sd_0 is
// worth n_0 of them. (Dempster, Laird and Rubin, 1977; inverse-gamma prior.)

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_SPREAD_ESTIMATOR_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_SPREAD_ESTIMATOR_H_

#include <array>

#include "reconstruct/solve/batch_problem.h"

namespace flocklift::internal {

class SpreadEstimator {
 public:
  explicit SpreadEstimator(const Spreads& now) : now_(now) {}  // what the errors were found with

  void BeginAnimal(double duration);
  void Add(Term term, double error, double variance);
  void Merge(const SpreadEstimator& other);
  void Update(const Spreads& guess, Spreads* spreads) const;

 private:
  double SdOf(Term term) const;

  Spreads now_;
  double animals_ = 0;
  std::array<double, kTermCount> squares_{}, counts_{};
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_SPREAD_ESTIMATOR_H_
