// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The simulator: species of animals, each moving by a model, in one world. Deterministic: the same
// input gives the same bytes at any number of threads and with any kernel variant of this machine,
// because every animal sums its neighbours in an order that depends on the state alone.
//
// Neighbours are animals of the same species; what species share are the goals, the walls, the
// obstacles, the wind and the predators.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_ENGINE_H_
#define FLOCKLIFT_SIMULATE_FLOCK_ENGINE_H_

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "simulate/core/scene.h"
#include "simulate/core/trajectory.h"
#include "simulate/flock/model.h"
#include "simulate/flock/world.h"

namespace flocklift {

// One species and where its animals start.
struct Swarm {
  std::string species;
  ModelParameters model;  // ResolveModel makes it
  std::vector<Vec3d> position, velocity;
  std::vector<double> cruising_speed = {};  // [m/s], one each; empty: the starting speeds
  std::vector<double> radius = {};          // of the bodies [m], one each; empty: 0
  ModelSpec spec = {};                      // what `model` was made from; events change it
  std::string shape = {}, path = {};        // the species' own, by name
  std::string start_shape = {};             // likewise
  std::vector<ModelSpec> forces = {};       // added to the model's
  Settling settled = {};                    // of a swarm that forms a shape
};

struct EngineOptions {
  int threads = 1;     // 0: all that the machine has
  std::string kernel;  // "scalar" or a name of kKernels; empty: the fastest there is
};

// T = float is the simulator; T = double is the reference that its tests compare it with.
template <typename T>
class BasicEngine {
 public:
  // Throws std::invalid_argument for numbers that make no sense (lengths that differ, dt <= 0), and
  // InputError for what the scene's file got wrong.
  BasicEngine(const World& world, const std::vector<Swarm>& swarms, const EngineOptions& options);
  ~BasicEngine();
  BasicEngine(BasicEngine&&) noexcept;
  BasicEngine& operator=(BasicEngine&&) noexcept;

  // Throws std::runtime_error when the state is not finite any more.
  void Step();

  // All animals by id: from 1, species after species in their order, the predators last.
  FlockState State() const;

  // The corners of the species that are tetrahedra, four for each, species after species [m].
  std::vector<Vec3<float>> TetrahedraCorners();

  // The accelerations of the models' forces at the last step, by the same order; zero for models
  // that have none [m/s^2].
  std::vector<Vec3d> Accelerations() const;

  // Changes from the next step on; what an [[event]] does, for whoever steers. Throws
  // std::out_of_range for a species, goal or predator (from 0, in the order of their ids) that is
  // not there, InputError as ResolveModel does.
  void SetParameters(const std::string& species, const ModelSpec& change);
  void MoveGoal(std::size_t index, const Vec3d& position);
  void MovePredator(std::size_t index, const Vec3d& position);
  void SetWind(const Vec3d& velocity);

  // The whole state as bytes, and back into an engine that was made alike: it goes on as the saved
  // one would have. Throws std::runtime_error when the bytes are of another flock.
  std::string Save() const;
  void Load(std::string_view bytes);

  std::int64_t steps() const;
  double time() const;            // [s]
  double MeanNeighbours() const;  // an animal and step, over all steps so far
  double MdeShare() const;        // animals that minimum-distance enforcement moved, likewise

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
