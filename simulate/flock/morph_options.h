// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The parameters of flock morphing under the names of equations.md, section 7.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_MORPH_OPTIONS_H_
#define FLOCKLIFT_SIMULATE_FLOCK_MORPH_OPTIONS_H_

#include <cstdint>
#include <string>

#include "simulate/core/vec3.h"
#include "simulate/flock/target_region.h"
#include "simulate/shapes/tetra_morph.h"

namespace flocklift {

enum class MorphStyle { kNone, kCurl, kWind, kGravity };

struct MorphOptions {
  double speed0 = 10;  // of the flock along the path [m/s]
  double omega1 = 1;   // of the path's velocity
  double omega2 = 0;   // of the style's velocity

  double departure_time = 4;      // from the first to the last departure [s]
  double width = 0;               // of the path; 0: nobody is drawn to it [m]
  double pull = 2;                // how fast who is outside comes back [1/s]
  double d_min = 0;               // minimum distance of centroids; 0: no enforcement [m]
  bool space_near_target = true;  // keep it in phase 2 too, until shortly before the place

  MorphStyle style = MorphStyle::kNone;
  double gain = 0.3, scale = 0.6;  // of the curl noise [m^2/s, m]
  double wind_speed = 0.5;         // mean of the wind, and sd of its turbulence [m/s]
  Vec3d wind{1, 0, 0};             // where it blows, any length
  double wind_time = 0.5;          // how long a gust lasts [s]
  double gravity = 9.81;           // of the gravitational style [m/s^2]
  double fall_speed = 5;           // it reaches no more than that [m/s]

  double k_a = 1;                 // range of the obstacles [m]
  bool avoid_near_target = true;  // around obstacles in phase 2 too

  RegionKind region = RegionKind::kShape;
  double margin = 1;  // of box and shape about the target [m]

  double shrink = 0.5;       // edge in flight / at rest (0.5: an eighth of the volume)
  double shrink_time = 0.3;  // after leaving [s]
  double morph_share = 0.6;  // of phase 2 for the change of shape, the rest for growing; in (0, 1)
  MorphKind kind = MorphKind::kShoemake;
  bool match_corners = true;  // pair corners so that tetrahedra turn least
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_MORPH_OPTIONS_H_
