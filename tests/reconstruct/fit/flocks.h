// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Flocks for the tests of the fit, flown by the simulator.

#ifndef FLOCKLIFT_TESTS_RECONSTRUCT_FIT_FLOCKS_H_
#define FLOCKLIFT_TESTS_RECONSTRUCT_FIT_FLOCKS_H_

#include "simulate/core/rng.h"
#include "simulate/core/scene.h"
#include "simulate/flock/simulate_scene.h"

namespace flocklift {

// 20 birds, 8 s at 30 frames/s, by boids with every weight spelled out.
inline Scene BoidsScene(std::uint64_t seed) {
  Scene scene;
  scene.seed = seed;
  scene.duration = 8;
  scene.fps = 30;
  scene.warmup = 3;
  SpeciesSpec species;
  species.count = 20;
  species.model.parameters = {
      {"d_s", 2.0},     {"d_v", 12.0},  {"alpha_s", 2.0},   {"alpha_c", 0.1},    {"alpha_a", 0.8},
      {"alpha_b", 8.0}, {"s_min", 6.0}, {"s_max", 14.0},    {"wall_taper", 6.0}, {"cruise", 1.2},
      {"level", 0.5},   {"noise", 2.0}, {"noise_time", 0.6}};
  scene.species = {species};
  return scene;
}

inline Trajectories Fly(const Scene& scene) { return SimulateScene(scene, {}, {}).truth; }

// Independent noise on every position [m].
inline Trajectories WithNoise(Trajectories flock, double sd, std::uint64_t seed) {
  for (Trajectory& trajectory : flock.trajectories) {
    Rng rng(seed, static_cast<std::uint64_t>(trajectory.id));
    for (TrajectoryPoint& point : trajectory.points) {
      point.position += sd * Vec3d{rng.Normal(), rng.Normal(), rng.Normal()};
    }
  }
  return flock;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_RECONSTRUCT_FIT_FLOCKS_H_
