// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The force terms that a scene may add to a species ([[species.force]], `type` is the name), with
// their parameters. The formulas are in simulate/forces/.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_FORCE_TYPES_H_
#define FLOCKLIFT_SIMULATE_FLOCK_FORCE_TYPES_H_

#include <string>
#include <variant>
#include <vector>

#include "simulate/core/options.h"
#include "simulate/core/scene.h"
#include "simulate/flock/registry.h"

namespace flocklift {

// Neighbours nearer than `radius`, with an edge `taper` wide.
struct NeighbourForce {
  double gain = 1, radius = 5, taper = 0;
};
struct SeparationForce : NeighbourForce {};
struct CohesionForce : NeighbourForce {};
struct AlignmentForce : NeighbourForce {};
struct RepulsionForce : NeighbourForce {
  double exponent = 1;
};
struct GoalForce {
  double range = 15;
};
struct WallForce {
  double gain = 8, taper = 6;
};
struct CruiseForce {
  double rate = 1;
};
struct LevelForce {
  double rate = 0.5;
};
struct FleeForce {
  double gain = 1;
};
struct WindForce {
  double rate = 1;
};
struct DragForce {
  double rate = 1;
};
struct GravityForce {
  double g = 9.81;
};
struct NoiseForce {
  double sd = 2.5, time = 0.8;
};

// A field of accelerations that stands in space.
struct FieldNoiseForce {
  double gain = 0.125, scale = 0.32;
};
struct CurlForce : FieldNoiseForce {};
struct PerlinForce : FieldNoiseForce {};

template <typename Visitor>
void DescribeNeighbours(Visitor& visit, NeighbourForce& p, const char* unit, const char* help) {
  visit("gain", p.gain, {.low = -1e6, .high = 1e6}, unit, help);
  visit("radius", p.radius, {.low = 0, .high = 1e6}, "m", "animals nearer than this count");
  visit("taper", p.taper, {.low = 0, .high = 1e6}, "m", "width of the radius's edge; 0: hard");
}
template <typename Visitor>
void Describe(Visitor& visit, SeparationForce& p) {
  DescribeNeighbours(visit, p, "1/s^2", "weight of the mean offset of the others");
}
template <typename Visitor>
void Describe(Visitor& visit, CohesionForce& p) {
  DescribeNeighbours(visit, p, "1/s^2", "weight of the offset to the others' mean position");
}
template <typename Visitor>
void Describe(Visitor& visit, AlignmentForce& p) {
  DescribeNeighbours(visit, p, "1/s", "weight of the difference to the others' mean velocity");
}
template <typename Visitor>
void Describe(Visitor& visit, RepulsionForce& p) {
  DescribeNeighbours(visit, p, "m^k/s^2", "weight of the mean of 1/distance^k");
  visit("exponent", p.exponent, {.low = 0, .high = 4}, "", "k");
}
template <typename Visitor>
void Describe(Visitor& visit, GoalForce& p) {
  visit("range", p.range, {.low = 1e-6, .high = 1e6}, "m",
        "goals pull as springs nearer than this, constantly beyond");
}
template <typename Visitor>
void Describe(Visitor& visit, WallForce& p) {
  visit("gain", p.gain, {.low = 0, .high = 1e6}, "m/s^2", "push of a wall on what is outside");
  visit("taper", p.taper, {.low = 0, .high = 1e6}, "m", "way over which it sets in; 0: hard");
}
template <typename Visitor>
void Describe(Visitor& visit, CruiseForce& p) {
  visit("rate", p.rate, {.low = 0, .high = 1e6}, "1/s", "of the return to the own cruising speed");
}
template <typename Visitor>
void Describe(Visitor& visit, LevelForce& p) {
  visit("rate", p.rate, {.low = 0, .high = 1e6}, "1/s", "damping of climbing and sinking");
}
template <typename Visitor>
void Describe(Visitor& visit, FleeForce& p) {
  visit("gain", p.gain, {.low = 0, .high = 1e6}, "", "times the predators' fear_weight");
}
template <typename Visitor>
void Describe(Visitor& visit, WindForce& p) {
  visit("rate", p.rate, {.low = 0, .high = 1e6}, "1/s", "at which the scene's wind carries along");
}
template <typename Visitor>
void Describe(Visitor& visit, DragForce& p) {
  visit("rate", p.rate, {.low = 0, .high = 1e6}, "1/s", "viscous: the loss of velocity");
}
template <typename Visitor>
void Describe(Visitor& visit, GravityForce& p) {
  visit("g", p.g, {.low = -1e6, .high = 1e6}, "m/s^2", "downwards");
}
template <typename Visitor>
void Describe(Visitor& visit, NoiseForce& p) {
  visit("sd", p.sd, {.low = 0, .high = 1e6}, "m/s^2", "standard deviation, per axis");
  visit("time", p.time, {.low = 0, .high = 1e6}, "s", "correlation time; 0: white");
}

template <typename Visitor>
void DescribeFieldNoise(Visitor& visit, FieldNoiseForce& p) {
  visit("gain", p.gain, {.low = 0, .high = 1e6}, "m^2/s^2",
        "eta: the acceleration is of the order gain / scale");
  visit("scale", p.scale, {.low = 1e-6, .high = 1e6}, "m", "rho: edge of a lattice cell");
}
template <typename Visitor>
void Describe(Visitor& visit, CurlForce& p) {
  DescribeFieldNoise(visit, p);
}
template <typename Visitor>
void Describe(Visitor& visit, PerlinForce& p) {
  DescribeFieldNoise(visit, p);
}

using ForceParameters =
    std::variant<SeparationForce, CohesionForce, AlignmentForce, RepulsionForce, GoalForce,
                 WallForce, CruiseForce, LevelForce, FleeForce, WindForce, DragForce, GravityForce,
                 NoiseForce, CurlForce, PerlinForce>;

const std::vector<ModelInfo>& ForceTypes();

// Registry::Resolve and Registry::Complete of the force terms.
ForceParameters ResolveForce(const ModelSpec& spec);
ModelSpec CompleteForce(const ModelSpec& spec);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_FORCE_TYPES_H_
