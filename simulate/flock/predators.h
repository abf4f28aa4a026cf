// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Predators that wander, each at its speed in a random direction with a new one every now and then,
// or chase, each at its speed after the animal that is nearest; outside the box they turn back to
// the middle. Others flee from them (simulate/forces/flee.h).

#ifndef FLOCKLIFT_SIMULATE_FLOCK_PREDATORS_H_
#define FLOCKLIFT_SIMULATE_FLOCK_PREDATORS_H_

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "simulate/core/scene.h"
#include "simulate/core/state_archive.h"
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
  bool chases = false;
};

class Predators {
 public:
  // They start anywhere in the box, which must be finite if there is a predator.
  Predators(const std::vector<PredatorSpec>& specs, const Region& box, int dimensions,
            std::uint64_t seed);

  // `nearest_animal` is where the animal nearest to a place is.
  void Step(double dt, std::uint32_t step,
            const std::function<Vec3d(const Vec3d&)>& nearest_animal);

  void Save(StateWriter* out) const { out->Put(predators_); }
  void Load(StateReader* in) { in->Take(&predators_); }
  std::span<const Predator> all() const { return predators_; }

 private:
  Region box_;
  int dimensions_;
  std::uint64_t seed_;
  std::vector<Predator> predators_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_PREDATORS_H_
