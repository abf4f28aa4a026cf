// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The simulator: species of animals, each moving by a model, in one world. Deterministic: the same
// input gives the same bytes at any number of threads and with any kernel variant of this machine,
// because every animal sums its neighbours in an order that depends on the state alone.
//
// Neighbours are animals of the same species; what species share are the goals, the walls and the
// predators.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_ENGINE_H_
#define FLOCKLIFT_SIMULATE_FLOCK_ENGINE_H_

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "simulate/core/scene.h"
#include "simulate/core/trajectory.h"
#include "simulate/flock/model.h"

namespace flocklift {

// What surrounds the flock. Without a box there are no walls.
struct World {
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  std::uint64_t seed = 1;
  double dt = 1.0 / 120;  // of a step [s]
  double time = 0;        // at the start [s]; goals move with it
  int dimensions = 3;     // 2: z stays 0
  Region box{{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}};
  std::vector<GoalSpec> goals;
  std::vector<PredatorSpec> predators;
};

// One species and where its animals start.
struct Swarm {
  std::string species;
  ModelParameters model;  // ResolveModel makes it
  std::vector<Vec3d> position, velocity;
  std::vector<double> cruising_speed;  // [m/s], one each; empty: the starting speeds
};

struct EngineOptions {
  int threads = 1;     // 0: all that the machine has
  std::string kernel;  // "scalar" or a name of kBoidsKernels; empty: the fastest there is
};

// Where a goal is at a time [s].
Vec3d GoalPosition(const GoalSpec& goal, double time);

// T = float is the simulator; T = double is the reference that its tests compare it with.
template <typename T>
class BasicEngine {
 public:
  // Throws std::invalid_argument for numbers that make no sense (lengths that differ, dt <= 0).
  BasicEngine(const World& world, const std::vector<Swarm>& swarms, const EngineOptions& options);
  ~BasicEngine();
  BasicEngine(BasicEngine&&) noexcept;
  BasicEngine& operator=(BasicEngine&&) noexcept;

  // Throws std::runtime_error when the state is not finite any more.
  void Step();

  // All animals by id: from 1, species after species in their order, the predators last.
  FlockState State() const;

  // The accelerations of the boids' pair terms at the last step, by the same order; zero for other
  // models [m/s^2].
  std::vector<Vec3d> PairAccelerations() const;

  std::int64_t steps() const;
  double time() const;            // [s]
  double MeanNeighbours() const;  // an animal and step, over all steps so far

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

extern template class BasicEngine<float>;
extern template class BasicEngine<double>;

using Engine = BasicEngine<float>;
using ReferenceEngine = BasicEngine<double>;

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_ENGINE_H_
