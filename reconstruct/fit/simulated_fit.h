// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Parameters of a model that has no usable derivatives, by the method of simulated moments
// (McFadden 1989): the statistics S (motion_statistics.h) of R simulations are brought near those
// of the data,
//   J(theta) = sum_q ((mean_r S_q(theta, seed_r) - S_q data) / sd_q)^2
// with sd_q from seed to seed at the start, and the same seeds at every theta, so that J is a
// function. Searched in log theta, between theta / range and theta range, by NLopt: a global search
// (controlled random search, or ISRES) and BOBYQA from where it ends, or BOBYQA alone; where J then
// is above that of another seed's data, BOBYQA from the start too. With
// G = dS / d log theta, W = diag(1 / sd^2) and C the covariance of S between seeds, at the
// estimate,
//   cov log theta = (1 + 1/R) M C M',   M = (G' W G)^-1 G' W
// so that what the statistics do not feel, beside their spread from seed to seed, has a large sd.
// sd_q is at least 0.3 % of the statistic's largest quantile (of polarisation 0.003), and C that on
// its diagonal: no model is nearer to what it models, and one without noise has no spread. Where J
// at its best is above that of another seed's data the covariance is as many times larger. The
// search keeps to the model's range. That is the bend of J at one point, and J may be as low far
// away. Acceptable is a theta whose J is no greater than another seed of the estimate would have as
// data, or no farther above the best J than J differs between such seeds. The sd is no less than 1
// / 1.96 of the way to the farthest acceptable theta tried. As long as that leaves a parameter
// known, the others are fitted again with it held 3 sd or more away, on either side (BOBYQA in that
// part of the search's box, from three places), until nothing acceptable is found there or it is no
// longer known. Of one that is not known the sd is a least one; it is infinite where the search
// ended near its bounds.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_SIMULATED_FIT_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_SIMULATED_FIT_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "reconstruct/fit/motion_statistics.h"
#include "simulate/core/options.h"
#include "simulate/core/progress.h"

namespace flocklift {

enum class SimulatedSearch { kBobyqa, kCrs, kIsres };  // the latter two, then BOBYQA

struct SimulatedFitOptions {
  SimulatedSearch search = SimulatedSearch::kCrs;
  int simulations = 3;                                    // R
  int global_evaluations = 600, local_evaluations = 250;  // at most
  double range = 5;                                       // above 1
  int spread_seeds = 12;                                  // that sd_q and C are taken from
  double difference = 0.1;                                // of log theta, for G
  double known = 0.25;             // half a 95 % interval of log theta that is worth a challenge
  int challenge_evaluations = 30;  // at most, from each of three starts on either side
  int nuisance = 0;                // of theta, at its end: fitted, never challenged
  std::vector<Range> legal = {};   // of each of theta; empty: any number
  std::uint64_t seed = 1;
  int threads = 1;
};

// The statistics of one simulation; nothing where it has none. Called from several threads.
using SimulatedStatistics = std::function<std::optional<MotionStatistics>(
    const std::vector<double>& theta, std::uint64_t seed)>;

struct SimulatedFit {
  bool usable = false;              // could the start be simulated?
  std::vector<double> estimate;     // p
  std::vector<double> log_sd;       // p, of the logarithms; infinite where nothing is known
  std::vector<double> correlation;  // p x p, row-major
  // By statistic: rms over its quantiles of (S - S data) in sd from seed to seed at the estimate.
  // About 1 for another simulation of the truth.
  std::array<double, kMotionStatistics.size()> misfit{};
  double start_cost = 0, cost = 0;  // J
  int evaluations = 0;
};

// `start` has p positive values. Deterministic in options and start, at any number of threads.
SimulatedFit FitSimulated(const SimulatedFitOptions& options, const SimulatedStatistics& simulate,
                          const MotionStatistics& data, const std::vector<double>& start,
                          const Progress& progress = {});

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_SIMULATED_FIT_H_
