// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/force_posterior.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace flocklift::internal {
namespace {

constexpr double kUnsure = 1.4;  // errors over what the linearised posterior says, as measured
constexpr int kIterations = 6;

std::vector<std::vector<double>> Linear(int draws, CoupledFlock* coupled) {
  std::vector<std::vector<double>> variances = coupled->Depths(draws).at;
  for (std::vector<double>& animal : variances) {
    for (double& value : animal) value *= kUnsure * kUnsure * value;
  }
  return variances;
}

}  // namespace

double ForcePosterior::Rms() const {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < linear.size(); ++i) {
    for (const double variance : linear[i]) {
      sum += variance + open[i];
      ++count;
    }
  }
  return std::sqrt(sum / std::max(count, 1.0));
}

ForcePosterior PosteriorOf(const BatchModel& model, FollowedFlock* flock) {
  CoupledFlock coupled = flock->Settle(model, kIterations);
  constexpr int kRough = 1, kFine = 4;  // draws: of the mean over all animals, of each one
  ForcePosterior posterior{Linear(kRough, &coupled), {}};
  for (const double sd : flock->open) posterior.open.push_back(sd * sd);
  const double width = std::sqrt(8) * posterior.Rms() * std::exp(coupled.scale().log_depth);
  double& log_taper = coupled.forces.unknowns[kLogTaper];
  if (width > std::exp(log_taper)) {
    log_taper = std::log(width);
    coupled.Relinearize();
  }
  posterior.linear = Linear(kFine, &coupled);
  return posterior;
}

}  // namespace flocklift::internal
