// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Continuum crowds (simulate/fields/crowd_field.h; A. Treuille, S. Cooper, Z. Popovic, "Continuum
// crowds", ACM Trans. Graph. 25 (2006) 1160-1168), the baseline of the noise-aware swarm. Animals
// without inertia follow the velocity of their group's potential:
//   V = V_group(x) + noise + wind,   x += V dt,   then minimum-distance enforcement
// A species has a group for each of its goals, and animal k (from 0) belongs to goal k modulo the
// number of goals. All of its groups are one crowd; other species are not seen, but keep their
// distance. The box and the obstacles are walls. In a box lower than a cell, and in two dimensions,
// everybody walks on the ground: halfway up the box, on one layer of nodes, with noise along it.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_CROWD_MODEL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_CROWD_MODEL_H_

#include "simulate/core/options.h"
#include "simulate/fields/crowd_field.h"
#include "simulate/flock/swarm_model.h"

namespace flocklift {

struct CrowdParameters {
  CrowdOptions field;
  double cell = 1, interval = 0.1;
  double d_min = 0.5, body_size = 0;
  Choice noise{kSwarmNoiseNames, static_cast<int>(SwarmNoiseKind::kNone)};
  double scale = 0.4, gain = 0.25, evolution = 0;

  SwarmNoiseKind noise_kind() const { return static_cast<SwarmNoiseKind>(noise.index); }
};

template <typename Visitor>
void Describe(Visitor& visit, CrowdParameters& p) {
  visit("alpha", p.field.length_weight, {.low = 0}, "", "cost of a metre");
  visit("beta", p.field.time_weight, {.low = 1e-6}, "", "cost of a second");
  visit("gamma", p.field.discomfort_weight, {.low = 0}, "", "cost of a second along a wall");
  visit("f_max", p.field.max_speed, {.low = 1e-6}, "m/s", "speed where there is no crowd");
  visit("f_min", p.field.min_speed, {.low = 1e-6}, "m/s",
        "speed against the flow of a dense crowd");
  visit("rho_low", p.field.density_low, {.low = 1e-6}, "",
        "animals per node up to which there is no crowd; at least 2^-lambda");
  visit("rho_high", p.field.density_high, {.low = 1e-6}, "",
        "animals per node from which the flow alone sets the speed");
  visit("lambda", p.field.density_exponent, {.low = 1e-3, .high = 100}, "",
        "the larger, the more an animal's density keeps to its nearest node");
  visit("diagonal", p.field.diagonal, {.low = 1e-3, .high = 100}, "cells",
        "a; walls repel up to 2 a away");
  visit("cell", p.cell, {.low = 1e-3}, "m", "l, spacing of the grid");
  visit("interval", p.interval, {.low = 0}, "s", "the crowd is looked at so often; 0: every step");
  visit("d_min", p.d_min, {.low = 0}, "m", "least distance between animals; 0: not enforced");
  visit("body_size", p.body_size, {.low = 0, .high = 100}, "",
        "so many of its own radii (half wingspans) each animal keeps clear besides");
  visit("noise", p.noise, {}, "",
        "on top: none, white, perlin (the noise itself as a velocity), or curl, which turns at "
        "walls");
  visit("scale", p.scale, {.low = 1e-6}, "m", "size of the noise's vortices");
  visit("gain", p.gain, {.low = 0}, "m^2/s",
        "of the noise potential; its speed is about gain/scale");
  visit("evolution", p.evolution, {.low = 0}, "s",
        "the noise is another one after so long; 0: it stands still");
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_CROWD_MODEL_H_
