// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Predators that wander: each flies at its speed in a random direction and takes a new one every
// now and then; outside the box it turns back to the middle. Others flee from them
// (simulate/forces/flee.h); they chase nobody.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_PREDATORS_H_
#define FLOCKLIFT_SIMULATE_FLOCK_PREDATORS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "simulate/core/scene.h"
#include "simulate/core/vec3.h"

namespace flocklift {

struct Predator {
  Vec3d position;            // [m]
  Vec3d velocity;            // [m/s]
  Vec3d heading;             // unit, where it wants to go
  double until_turn = 0;     // [s]
  double speed = 0;          // [m/s]
  double fear_radius = 0;    // [m]
  double fear_weight = 0;    // [m/s^2]
  double turn_interval = 0;  // [s]
};

class Predators {
 public:
  // They start anywhere in the box, which must be finite if there is a predator.
  Predators(const std::vector<PredatorSpec>& specs, const Region& box, int dimensions,
            std::uint64_t seed);

  void Step(double dt, std::uint32_t step);
  std::span<const Predator> all() const { return predators_; }

 private:
  Region box_;
  int dimensions_;
  std::uint64_t seed_;
  std::vector<Predator> predators_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_PREDATORS_H_
