// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Every prior along a track is the same process: an error e(t) with standard deviation s that
// forgets itself over the time tau (Ornstein-Uhlenbeck; for accelerations, Singer's model). With
// knots h apart and rho = exp(-h / tau) its independent unit residuals are
//   e_0 / s,   (e_{k+1} - rho e_k) / (s sqrt(1 - rho^2)).
// (Singer, "Estimating optimal tracking filter performance for manned maneuvering targets", 1970)

#ifndef FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_MARKOV_H_
#define FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_MARKOV_H_

#include <cmath>

namespace flocklift {

struct MarkovProcess {
  double sd = 1;    // of the error at any time
  double time = 1;  // of correlation [s]

  double Correlation(double dt) const { return std::exp(-dt / time); }
  double StepSd(double rho) const { return sd * std::sqrt(1 - rho * rho); }
};

// The way from errors at steps of dt to those residuals: the error minus rho times the one before,
// times the inverse of its sd.
struct MarkovWhitening {
  double rho, first, next;

  MarkovWhitening(const MarkovProcess& process, double dt)
      : rho(process.Correlation(dt)), first(1 / process.sd), next(1 / process.StepSd(rho)) {}
  double At(int knot) const { return knot == 0 ? first : next; }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_MARKOV_H_
