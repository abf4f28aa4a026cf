// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// BSwarm (Wang et al. 2015; Ren et al. 2016; equations.md, section 3): forces make a preferred
// velocity, collision avoidance makes the velocity.
//   a  = three zones of neighbours (simulate/forces/zones.h)
//      + drive (speed to the goal - v)         goal-directed; without a goal along the own heading
//      + escape: away from predators
//      + curl noise as a force (equations.md, section 4), white or correlated noise, walls
//   v* = limit(v + a dt, s_max),   v = v* or ORCA(v*)  (simulate/flock/orca.h),   x += v dt
// or, instead of ORCA, minimum-distance enforcement after the move
// (simulate/flock/minimum_distance.h).
// The published papers give no numbers for all but the zones (Chen et al. 2019) and the noise.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_BSWARM_MODEL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_BSWARM_MODEL_H_

#include <string_view>

#include "simulate/core/options.h"
#include "simulate/flock/zone_pairs.h"

namespace flocklift {

inline constexpr std::string_view kAvoidances[] = {"none", "orca", "distance"};
enum class Avoidance { kNone, kOrca, kDistance };

struct BSwarmParameters {
  ZoneParameters zones;
  double most = 0;    // neighbours of alignment and attraction; 0: all
  double drive = 2;   // [1/s]
  double escape = 1;  // times the predators' fear_weight
  double curl_gain = 0.125, curl_scale = 0.32, curl_evolution = 0;
  double noise = 0, noise_time = 0;       // [m/s^2], [s]
  double alpha_b = 20, wall_taper = 0.5;  // [m/s^2], [m]
  double s_max = 0.75;                    // [m/s]
  Choice avoid{kAvoidances, static_cast<int>(Avoidance::kOrca)};
  double room = 0;       // kept around the body [m]
  double horizon = 0.5;  // [s]
  double sight = 0.5;    // of avoidance [m]
};

template <typename Visitor>
void Describe(Visitor& visit, BSwarmParameters& p) {
  visit("r_rep", p.zones.r_rep, {.low = 0}, "m", "animals nearer than this repel");
  visit("r_ali", p.zones.r_ali, {.low = 0}, "m", "nearer than this, from r_rep on, they align");
  visit("r_att", p.zones.r_att, {.low = 0}, "m", "nearer than this, from r_ali on, they attract");
  visit("w_rep", p.zones.w_rep, {.low = 0}, "m/s^2", "weight of repulsion (omega_rep)");
  visit("w_ali", p.zones.w_ali, {.low = 0}, "m/s^2", "weight of alignment (omega_ali)");
  visit("w_att", p.zones.w_att, {.low = 0}, "m/s^2", "weight of attraction (omega_att)");
  visit("taper", p.zones.taper, {.low = 0}, "m",
        "width of the zones' edges; 0: hard, as published");
  visit(
      "most", p.most, {.low = 0, .high = 1e6}, "",
      "alignment and attraction hear a sample of about that many candidates, another one at every "
      "step; 0: everybody");
  visit("drive", p.drive, {.low = 0}, "1/s",
        "rate at which an animal takes up its own speed: to the goal, or straight on without one");
  visit("escape", p.escape, {.low = 0}, "", "times the predators' fear_weight");
  visit("curl_gain", p.curl_gain, {.low = 0}, "m^3/s^2", "strength of the curl noise (eta)");
  visit("curl_scale", p.curl_scale, {.low = 1e-6}, "m", "size of its eddies (rho)");
  visit("curl_evolution", p.curl_evolution, {.low = 0}, "s",
        "another curl noise has taken over after that long; 0: it stays");
  visit("noise", p.noise, {.low = 0}, "m/s^2",
        "standard deviation of the random acceleration, per axis");
  visit("noise_time", p.noise_time, {.low = 0}, "s",
        "correlation time of the random acceleration; 0: fresh at every step");
  visit("alpha_b", p.alpha_b, {.low = 0}, "m/s^2", "push of a wall on what is outside");
  visit("wall_taper", p.wall_taper, {.low = 0}, "m", "way over which a wall's push sets in");
  visit("s_max", p.s_max, {.low = 0}, "m/s", "highest speed");
  visit("avoid", p.avoid, {}, "",
        "collision avoidance: velocity obstacles (orca), minimum-distance enforcement (distance), "
        "none");
  visit("room", p.room, {.low = 0}, "m", "kept around the body by collision avoidance");
  visit("horizon", p.horizon, {.low = 1e-3}, "s", "within which no collision may come");
  visit("sight", p.sight, {.low = 0}, "m", "animals and obstacles nearer than this are avoided");
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_BSWARM_MODEL_H_
