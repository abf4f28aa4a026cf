// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A model fitted by simulated statistics (simulated_fit.h): simulations start from the flock as it
// is in its fullest frame and go on for as long as the data do, or `statistics_time`, in a scene's
// surroundings where one is given (engine_flight.h); each animal's own speed is its mean speed
// times a common factor, fitted too where the model has a `drive` (walls and noise keep a flock
// from flying at its own speed). Nothing of an animal's path enters but its start, so that any
// model that the engine flies can be fitted, however hard its cut-offs. Position noise counts as
// motion: accelerations must come from smooth paths.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_STATISTICS_FIT_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_STATISTICS_FIT_H_

#include <cstdint>
#include <string>
#include <vector>

#include "reconstruct/fit/fit.h"

namespace flocklift::internal {

// Is that how the model is fitted, whatever surrounds the animals?
bool KnownByStatistics(const std::string& model);

// What is freed when nothing is named: of bswarm and opensteer the weights and radii, of lin what
// leads to the target; of shape the share of its own forces, the pull, the speed's limits and the
// noise, of morph speed, weights and time of departure, of crowd speeds and costs; of others
// nothing, and with terms that a scene adds their weights. Of those gain, rate, g or sd of each. In
// a scene as far as they are not 0.
std::vector<std::string> StatisticsParameters(const ModelSpec& model);

// Does the model fly to what only a scene says?
bool NeedsScene(const std::string& model);

FitResult FitStatistics(const FitOptions& options, const FitProblem& problem,
                        const Trajectories& trajectories, double fps, std::uint64_t seed,
                        int threads, const Progress& progress);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_STATISTICS_FIT_H_
