// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Errors of a reconstruction, drawn: each animal's positions moved along its lines of sight by a
// smooth random error of the standard deviation that the file states,
//   eps(t) = sd_depth(t) sqrt(1 / M) sum_m ( a_m cos(w_m t) + b_m sin(w_m t) ),
// a, b ~ N(0, 1), w ~ N(0, 1 / time^2): a Gaussian process with correlation exp(-dt^2 / (2 time^2))
// over the draws (random Fourier features, Rahimi and Recht 2007).
// Refitting after another error of the same size tells what the first one did (simulation
// extrapolation, Cook and Stefanski 1994).

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_DEPTH_NOISE_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_DEPTH_NOISE_H_

#include <cstdint>
#include <optional>

#include "simulate/camera/camera.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

struct DepthNoiseOptions {
  double time = 2;      // correlation time of an error [s]
  double scale_sd = 0;  // relative sd of the common scale, which sd_depth includes: it moves all
                        // animals alike and is taken off before drawing
  std::uint64_t seed = 1;
  std::uint32_t draw = 0;
};

// The direction in the world along which depth grows by 1 m per unit, from the camera's eye through
// a position; without a camera the eye is the world's origin and depth the distance from it.
Vec3d DepthDirection(const std::optional<Camera>& camera, int frame, const Vec3d& position);

// How far the eye is from a position, and one sd of the depth alone, without the common scale's, as
// a share of that.
struct DepthShare {
  Vec3d sight;  // from the eye [m]
  double own = 0;
};
DepthShare DepthShareOf(const std::optional<Camera>& camera, int frame, const Vec3d& position,
                        double sd_depth, double scale_sd);

Trajectories AddDepthNoise(const DepthNoiseOptions& options, const std::optional<Camera>& camera,
                           double fps, const Trajectories& trajectories);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_DEPTH_NOISE_H_
