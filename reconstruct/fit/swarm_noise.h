// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The curl noise behind trajectories of the model swarm (simulate/flock/swarm_model.h), by
// noise_field.h. Velocities are displacements over a frame; positions are where, on average over
// its steps, the engine asked the field. Left out is who feels more than the noise: animals within
// `cell` of the walls, which turn it, and beyond the given goal's reach, on their way there. Noise
// that evolves is taken at times two `evolution` apart, when nothing of the earlier field is left.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_SWARM_NOISE_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_SWARM_NOISE_H_

#include "reconstruct/fit/fit.h"
#include "reconstruct/fit/noise_field.h"
#include "reconstruct/fit/observed_flock.h"

namespace flocklift::internal {

// Does nothing but the noise move an animal here? `cell` is the model's.
bool DriftsFreely(const FitProblem& problem, double cell, const Vec3d& x);

// Of the animals that drift freely, between a frame and the next.
VelocitySample DriftIn(const FitOptions& options, const FitProblem& problem, const ModelSpec& model,
                       const ObservedFlock& flock, int frame);

// The velocities that FitSwarmNoise fits, one sample for each independent field.
std::vector<VelocitySample> DriftSamples(const FitOptions& options, const FitProblem& problem,
                                         const ModelSpec& model, const Trajectories& trajectories,
                                         double fps);

FitResult FitSwarmNoise(const FitOptions& options, const FitProblem& problem,
                        const Trajectories& trajectories, double fps, int threads);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_SWARM_NOISE_H_
