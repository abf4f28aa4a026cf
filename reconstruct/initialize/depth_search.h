// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where to start the depths of one animal: the best path on a grid of log depth, by dynamic
// programming over (log z, its slope). Smoothness and speed alone leave a reversal of depth open,
// and descent from a constant depth falls into the wrong one; the grid sees both. With points
// p_k = camera_k + exp(L_k) (x_k, y_k, 1) at steps of H seconds the cost is the sum of
//   ((log |p_{k+1} - p_k| / H - log speed) / speed_sd)^2 share      squares beyond 3 sd count
//   (|p_{k+2} - 2 p_{k+1} + p_k| / (H^2 z_k / z_ref) / acceleration_sd)^2 share   linearly
//   ((log size_k - log width + L_k) / size_sd)^2 share
//   (climb / climb_sd)^2 share,  ((L_k - log_depth) / depth_sd)^2 share
//   ((L_k - log depth by a second camera) / a grid step)^2
// where share = H / (2 tau) turns correlated errors into as many independent ones.

#ifndef FLOCKLIFT_RECONSTRUCT_INITIALIZE_DEPTH_SEARCH_H_
#define FLOCKLIFT_RECONSTRUCT_INITIALIZE_DEPTH_SEARCH_H_

#include <optional>
#include <vector>

#include "simulate/core/vec3.h"

namespace flocklift {

struct DepthSearchPriors {
  double log_speed = 0, speed_sd = 0.15, speed_time = 1.5;  // log m/s
  double acceleration_sd = 3, acceleration_time = 0.7;      // [m/s^2]
  double log_width = 0, size_sd = 0.2, size_time = 0.3;     // log m, mean over all views
  double log_depth = 0, depth_sd = 0.5, depth_time = 3;     // of the flock's middle, log m
  double climb_sd = 0.15, climb_time = 1.5;                 // sine of the angle
  std::optional<Vec3d> up_in_cam;                           // climb counts only where known
  double log_near = 0, log_far = 1;                         // ends of the grid
};

// What is seen of the animal at one step of the grid.
struct DepthSearchStep {
  Vec2d ray;
  std::optional<double> log_size;                  // of the angular size
  std::optional<double> log_depth = std::nullopt;  // by a second camera
  Vec3d camera = {};                               // the place that the ray comes from [m]
};

// Log depth at every step (steps of `interval` seconds); within the grid always.
std::vector<double> SearchDepth(const DepthSearchPriors& priors, double interval,
                                const std::vector<DepthSearchStep>& steps);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_INITIALIZE_DEPTH_SEARCH_H_
