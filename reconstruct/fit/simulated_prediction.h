// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How well a model that is fitted by what its simulations do (statistics_fit.h, swarm_noise.h)
// foresees the last part of the time, by the score that other models have (fit_measures.h):
//   R^2 = 1 - sum |y - b yhat|^2 / sum |y|^2     over windows that are held out of the fit
// y the second difference over +- m frames, yhat that of the path on which the model takes the
// animals through the window, from the state foreseen (observed_flock.h) before it; b, from windows
// of the first part, makes up for the noise of those states. 0 is constant velocity.
//   bswarm and others   yhat is the mean over R noise seeds of the shared engine's flights;
//   |yhat|^2
//                       by products of different seeds, which their noise does not add to
//                       In a scene they fly among its surroundings (departure.h); tetrahedra that
//                       morph fly there from the scene's start on, whatever the state
//   swarm               another seed is another field, and their mean is none: yhat drifts in the
//                       field expected (noise_evidence.h) of the velocities seen before, over the
//                       first part, or, of noise that evolves, just before the window. Animals that
//                       something else moves fly straight on
// Windows are as many as are worth flying, spread over each part.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_SIMULATED_PREDICTION_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_SIMULATED_PREDICTION_H_

#include <cstdint>
#include <optional>
#include <string>

#include "reconstruct/fit/fit.h"

namespace flocklift {

struct SimulatedPrediction {
  FitResult fit;  // of the first part of the time
  std::optional<double> r2;
};

// Of `options`: held_out (above 0), window, longest_window, and what the fit takes. Throws what
// FitModel throws, and InputError for a model that cannot be flown.
SimulatedPrediction PredictBySimulation(const FitOptions& options, const FitProblem& problem,
                                        const Trajectories& trajectories, double fps,
                                        std::uint64_t seed, int threads);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_SIMULATED_PREDICTION_H_
