// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The noise-aware swarm (equations.md, sections 4 and 5; X. Wang, X. Jin, Z. Deng, L. Zhou,
// "Inherent noise-aware insect swarm simulation", Computer Graphics Forum 33 (2014) 51-62): animals
// without inertia in a velocity field,
//   V = curl N + V_g,   x += V dt,   then minimum-distance enforcement
// N is a noise potential that is aware of walls (obstacles and the scene's box), V_g leads down the
// cost of the way to the species' goals at the speed s0. Baselines take the place of curl N.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_SWARM_MODEL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_SWARM_MODEL_H_

#include <string_view>

#include "simulate/core/options.h"

namespace flocklift {

enum class SwarmNoiseKind { kNone, kWhite, kPerlin, kCurl };
inline constexpr std::string_view kSwarmNoiseNames[] = {"none", "white", "perlin", "curl"};
inline constexpr std::string_view kSwarmGoalNames[] = {"open", "solid"};

struct SwarmParameters {
  Choice noise{kSwarmNoiseNames, static_cast<int>(SwarmNoiseKind::kCurl)};
  double scale = 0.4, gain = 0.25, evolution = 0;
  double s0 = 1.5;
  double d_min = 0.05, body_size = 0;
  double cell = 0.5;
  double A = 0.6, B = 0.4, diagonal = 1.7320508075688772;
  double crowding = 0, crowding_interval = 0.5;
  Choice goal{kSwarmGoalNames, 0};
  double lamp_probability = 0, lamp_kick = 0;

  SwarmNoiseKind noise_kind() const { return static_cast<SwarmNoiseKind>(noise.index); }
  bool goal_is_solid() const { return goal.index == 1; }
};

template <typename Visitor>
void Describe(Visitor& visit, SwarmParameters& p) {
  visit("noise", p.noise, {}, "",
        "curl; as baselines perlin (the noise itself as a velocity), white, or none");
  visit("scale", p.scale, {.low = 1e-6}, "m", "size of the noise's vortices");
  visit("gain", p.gain, {.low = 0}, "m^2/s",
        "of the noise potential; its speed is about gain/scale");
  visit("evolution", p.evolution, {.low = 0}, "s",
        "the noise is another one after so long; 0: it stands still");
  visit("s0", p.s0, {.low = 0}, "m/s", "speed towards the goals");
  visit("d_min", p.d_min, {.low = 0}, "m", "least distance between animals; 0: not enforced");
  visit("body_size", p.body_size, {.low = 0, .high = 100}, "",
        "so many of its own radii (half wingspans) each animal keeps clear besides");
  visit("cell", p.cell, {.low = 1e-3}, "m",
        "l, spacing of the grid of distances and costs; walls turn the noise within l");
  visit("A", p.A, {.low = 1e-6}, "", "cost of a metre");
  visit("B", p.B, {.low = 0}, "", "further cost of a metre along a wall");
  visit("diagonal", p.diagonal, {.low = 1e-3, .high = 100}, "cells",
        "a; walls repel up to 2 a away (sqrt 3 in space; the paper's sqrt 2 is that of a square)");
  visit("crowding", p.crowding, {.low = 0}, "m^3",
        "further cost of a metre per animal of the species and m^3; 0: the cost ignores density");
  visit("crowding_interval", p.crowding_interval, {.low = 1e-3}, "s",
        "how often the density is looked at");
  visit("goal", p.goal, {}, "", "open, or solid: the noise flows round the goal's ball");
  visit("lamp_probability", p.lamp_probability, {.low = 0, .high = 1}, "",
        "of a kick towards the nearest goal, for each animal and step");
  visit("lamp_kick", p.lamp_kick, {.low = 0}, "m/s", "speed that a kick adds for a step");
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_SWARM_MODEL_H_
