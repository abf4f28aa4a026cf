// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Who a scene is about, and where they start.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_POPULATION_H_
#define FLOCKLIFT_SIMULATE_FLOCK_POPULATION_H_

#include <vector>

#include "simulate/core/animal.h"
#include "simulate/core/scene.h"
#include "simulate/flock/engine.h"

namespace flocklift {

// The scene at the start of its warm-up, its meshes read. Individuals differ: their cruising speeds
// by a relative standard deviation of speed_spread, their wingspans (with body lengths in
// proportion) by wingspan_spread in the logarithm; the mean over a species is exactly the scene's.
// They start anywhere in the species' region or on its start shape, headed for its goal, or
// together in a random direction.
struct Population {
  World world;
  std::vector<Swarm> swarms;
  std::vector<Animal> animals;  // by id, predators last
};

// Throws InputError for a model that the scene's file names wrongly or a mesh that cannot be read,
// std::invalid_argument for a scene that makes no sense.
Population Populate(const Scene& scene);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_POPULATION_H_
