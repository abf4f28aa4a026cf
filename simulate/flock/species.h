// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One species of the engine: what it was made from, its animals, and what moves them.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_SPECIES_H_
#define FLOCKLIFT_SIMULATE_FLOCK_SPECIES_H_

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include "simulate/core/check.h"
#include "simulate/core/parallel_for.h"
#include "simulate/core/scene.h"
#include "simulate/flock/engine.h"
#include "simulate/flock/herd.h"
#include "simulate/flock/motion.h"

namespace flocklift::internal {

// A species, what it was made from, and what moves it.
template <typename T>
struct Species {
  Swarm swarm;
  Herd<T> herd;
  std::unique_ptr<Motion<T>> motion;
  std::vector<T> bodies;  // room that the bodies need, in the order of the herd [m]
};

template <typename T>
Herd<T> MakeHerd(const Swarm& swarm, std::uint64_t first_agent, bool flat) {
  const std::size_t n = swarm.position.size();
  Check(swarm.velocity.size() == n, "a swarm needs as many velocities as positions");
  Check(swarm.cruising_speed.empty() || swarm.cruising_speed.size() == n,
        "a swarm needs as many cruising speeds as positions, or none");
  Check(swarm.radius.empty() || swarm.radius.size() == n,
        "a swarm needs as many radii as positions, or none");
  Herd<T> herd;
  herd.species = swarm.species;
  herd.first_agent = first_agent;
  herd.now.Resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    herd.now.Set(k, Flattened(flat, Cast<T>(swarm.position[k])),
                 Flattened(flat, Cast<T>(swarm.velocity[k])));
    herd.now.agent[k] = static_cast<std::uint32_t>(k);
    const double speed =
        swarm.cruising_speed.empty() ? Norm(swarm.velocity[k]) : swarm.cruising_speed[k];
    herd.cruising_speed.push_back(static_cast<T>(speed));
    herd.radius.push_back(swarm.radius.empty() ? T(0) : static_cast<T>(swarm.radius[k]));
  }
  for (std::vector<T>* column : {&herd.ax, &herd.ay, &herd.az, &herd.neighbours}) {
    column->assign(n + Bodies<T>::kPadding, T(0));
  }
  herd.sorted.Resize(n);
  herd.grid.Reserve(n);
  return herd;
}

// What the model finds amiss is a fault of the scene's file, where the species comes from one.
template <typename Work>
auto BlameFile(const ModelSpec& spec, const Work& work) {
  try {
    return work();
  } catch (const std::invalid_argument& error) {
    if (spec.where.empty()) throw;
    throw InputError(spec.where, 0, error.what(), "change the settings of this species");
  }
}

// `spec` with what `change` says instead.
inline ModelSpec Changed(ModelSpec spec, const ModelSpec& change) {
  if (!change.where.empty()) spec.where = change.where;
  for (const auto& [name, value] : change.parameters) spec.parameters[name] = value;
  for (const auto& [name, word] : change.choices) spec.choices[name] = word;
  for (const auto& [name, where] : change.where_of) spec.where_of[name] = where;
  return spec;
}

inline bool ChangesModels(const EventSpec& event) {
  return !event.change.parameters.empty() || !event.change.choices.empty();
}

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_FLOCK_SPECIES_H_
