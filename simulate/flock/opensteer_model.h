// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The boids of OpenSteer (Reynolds 1999, 2004; equations.md, section 1): steering forces of unit
// length, each with its own radius and view, weighted, their sum limited:
//   a = limit(12 separation + 8 alignment + 8 cohesion, max_force) + walls + goals + fear + noise
// then v += a dt, |v| <= s_max, x += v dt. OpenSteer besides smooths accelerations over a few
// frames and wraps its world around; here the scene's box has walls.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_OPENSTEER_MODEL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_OPENSTEER_MODEL_H_

#include <string>

#include "simulate/core/options.h"
#include "simulate/flock/steer_pairs.h"

namespace flocklift {

struct OpenSteerParameters {
  SteerParameters rules;
  double max_force = 27;                 // [m/s^2]
  double s_min = 0, s_max = 9;           // [m/s]
  double alpha_b = 27, wall_taper = 10;  // [m/s^2], [m]
  double goal_range = 15;                // [m]
  double noise = 0, noise_time = 0.8;    // [m/s^2], [s]
};

template <typename Visitor>
void DescribeSteerRule(Visitor& visit, const std::string& name, SteerRule& rule) {
  visit(name + "_weight", rule.weight, {.low = 0}, "m/s^2", "size of " + name);
  visit(name + "_radius", rule.radius, {.low = 0}, "m", "neighbours of " + name + " are nearer");
  visit(name + "_cosine", rule.cosine, {.low = -1, .high = 1}, "",
        "cosine of the half angle in which " + name + " has neighbours");
}

template <typename Visitor>
void Describe(Visitor& visit, OpenSteerParameters& p) {
  DescribeSteerRule(visit, "separation", p.rules.separation);
  DescribeSteerRule(visit, "alignment", p.rules.alignment);
  DescribeSteerRule(visit, "cohesion", p.rules.cohesion);
  visit("near", p.rules.near, {.low = 0}, "m", "animals nearer than this count at any angle");
  visit("taper", p.rules.taper, {.low = 0}, "m", "width of the radii's edges; 0: hard");
  visit("view_taper", p.rules.view_taper, {.low = 0, .high = 2}, "",
        "width of the angles' edges, in their cosine; 0: hard");
  visit("max_force", p.max_force, {.low = 0}, "m/s^2", "limit of the three rules together");
  visit("s_min", p.s_min, {.low = 0}, "m/s", "lowest speed");
  visit("s_max", p.s_max, {.low = 0}, "m/s", "highest speed");
  visit("alpha_b", p.alpha_b, {.low = 0}, "m/s^2", "push of a wall on what is outside");
  visit("wall_taper", p.wall_taper, {.low = 0}, "m", "way over which a wall's push sets in");
  visit("goal_range", p.goal_range, {.low = 1e-6}, "m",
        "an attraction point pulls as a spring nearer than this, constantly beyond");
  visit("noise", p.noise, {.low = 0}, "m/s^2",
        "standard deviation of the random acceleration, per axis");
  visit("noise_time", p.noise_time, {.low = 0}, "s",
        "correlation time of the random acceleration; 0: fresh at every step");
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_OPENSTEER_MODEL_H_
