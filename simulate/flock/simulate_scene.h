// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A scene, run: from the file's description to everybody's true path.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_SIMULATE_SCENE_H_
#define FLOCKLIFT_SIMULATE_FLOCK_SIMULATE_SCENE_H_

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "simulate/core/animal.h"
#include "simulate/core/progress.h"
#include "simulate/core/scene.h"
#include "simulate/core/trajectory.h"
#include "simulate/flock/world.h"

namespace flocklift {

struct SimulateOptions {
  int threads = 1;                            // 0: all that the machine has
  std::filesystem::path checkpoint = {};      // a folder to go on from; empty: none is kept
  std::chrono::seconds checkpoint_every{30};  // of wall time
  // Animals that are tetrahedra as one animated mesh (GLB); empty: none is written.
  std::filesystem::path tetrahedra = {};
};

struct SceneResult {
  Trajectories truth;           // with velocities and orientations; one id per animal for ever
  std::vector<Animal> animals;  // by id
  std::vector<Obstacle> obstacles;
  std::int64_t agents = 0;     // predators not counted
  std::int64_t steps = 0;      // warm-up included
  double mean_neighbours = 0;  // an animal and step
  double mde_share = 0;        // share of animals that minimum-distance enforcement moved, a step
  double prepare_wall_s = 0, prepare_cpu_s = 0;  // reading meshes, filling fields
  double step_wall_s = 0, step_cpu_s = 0;        // the steps alone, without recording them
};

// Frame f shows the time (f - 1) / fps. Wings bank with the turn: the body's up is that of the felt
// weight, acceleration less gravity. A run that was killed goes on from its checkpoint, which must
// be of the same scene (it is ignored otherwise), and ends with the same bytes; the checkpoint is
// removed at the end.
SceneResult SimulateScene(const Scene& scene, const SimulateOptions& options,
                          const Progress& progress);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_SIMULATE_SCENE_H_
