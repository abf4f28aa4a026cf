// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Flock morphing as a scene has it (equations.md, section 7; simulate/flock/flock_morph.h): the
// species' start_shape and shape are filled with its `count` of tetrahedra, and fly along its path.
// The path's own points are those between the two shapes' centroids, where it begins and ends.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_MORPH_MODEL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_MORPH_MODEL_H_

#include <string_view>

#include "simulate/core/options.h"

namespace flocklift {

inline constexpr std::string_view kMorphStyles[] = {"none", "curl", "wind", "gravity"};
inline constexpr std::string_view kMorphRegions[] = {"sphere", "box", "shape"};
inline constexpr std::string_view kMorphInterpolations[] = {"published", "shoemake"};
inline constexpr std::string_view kMorphNearTarget[] = {"published", "avoid"};

struct MorphParameters {
  double speed0 = 10, omega1 = 1, omega2 = 0;
  Choice style{kMorphStyles, 0};
  double gain = 0.3, scale = 0.6;
  double wind_speed = 0.5, wind_time = 0.5;
  double gravity = 9.81, fall_speed = 5;
  double start_time = 0, departure_time = 4, pull = 2;
  double d_min = 0, k_a = 1;
  Choice near_target{kMorphNearTarget, 1};
  Choice region{kMorphRegions, 2};
  double margin = 1;
  double shrink = 0.5, shrink_time = 0.3, morph_share = 0.6;
  Choice interpolation{kMorphInterpolations, 1};
};

template <typename Visitor>
void Describe(Visitor& visit, MorphParameters& p) {
  visit("speed0", p.speed0, {.low = 1e-9}, "m/s", "speed of the flock");
  visit("omega1", p.omega1, {.low = 0}, "", "weight of the path's velocity");
  visit("omega2", p.omega2, {.low = 0}, "", "weight of the style's velocity");
  visit("style", p.style, {}, "", "velocity besides the path's");
  visit("gain", p.gain, {.low = 0}, "m^2/s", "of the curl noise");
  visit("scale", p.scale, {.low = 1e-9}, "m", "of the curl noise");
  visit("wind_speed", p.wind_speed, {.low = 0}, "m/s",
        "mean and turbulence of the wind style; it blows where [wind] does, or along x");
  visit("wind_time", p.wind_time, {.low = 1e-9}, "s", "how long its turbulence lasts");
  visit("gravity", p.gravity, {.low = 0}, "m/s^2", "of the gravity style");
  visit("fall_speed", p.fall_speed, {.low = 0}, "m/s", "which it does not exceed");
  visit("start_time", p.start_time, {.low = 0}, "s", "when the first leaves");
  visit("departure_time", p.departure_time, {.low = 0}, "s", "from the first to the last");
  visit("pull", p.pull, {.low = 0}, "1/s", "back to the path beyond its width");
  visit("d_min", p.d_min, {.low = 0}, "m", "minimum distance; 0: none is enforced");
  visit("k_a", p.k_a, {.low = 0}, "m", "range of obstacles; 0: there are none for this species");
  visit("near_target", p.near_target, {}, "",
        "whether obstacles and distances count there too, or not, as published");
  visit("region", p.region, {}, "", "where tetrahedra leave the path for their places");
  visit("margin", p.margin, {.low = 1e-9}, "m", "of a box or shape about the target");
  visit("shrink", p.shrink, {.low = 1e-3, .high = 1}, "",
        "edge in flight / at rest; 0.5: an eighth of the volume, 0.125: of the size");
  visit("shrink_time", p.shrink_time, {.low = 1e-6}, "s", "after leaving");
  visit("morph_share", p.morph_share, {.low = 0.01, .high = 0.99}, "",
        "of the last leg for the change of shape; the rest is for growing");
  visit("interpolation", p.interpolation, {}, "", "of the shapes between");
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_MORPH_MODEL_H_
