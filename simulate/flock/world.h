// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What surrounds a flock: at the start (World), and at one step (Surroundings).

#ifndef FLOCKLIFT_SIMULATE_FLOCK_WORLD_H_
#define FLOCKLIFT_SIMULATE_FLOCK_WORLD_H_

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "simulate/core/scene.h"
#include "simulate/core/triangle_mesh.h"
#include "simulate/fields/solids.h"
#include "simulate/flock/predators.h"
#include "simulate/shapes/tetra_mesh.h"

namespace flocklift {

// An [[obstacle]]: what is drawn, and what is measured.
struct Obstacle {
  TriangleMesh mesh;  // closed, world frame
  Solid solid;
};

// A [[shape]] with its meshes read and placed. With a period the key-frames are an animation: they
// share their triangles, and the last passes over into the first. Without one they are shapes of
// their own, one after the other.
struct ShapeInTime {
  std::string name;
  std::vector<double> times;         // of the key-frames, increasing [s]
  std::vector<TriangleMesh> meshes;  // one for each time, world frame
  double period = 0;                 // [s]
  std::string path;                  // along which it moves; empty: it stands
  // The first mesh as tetrahedra, for whoever flies the same morph many times; empty: filled anew.
  std::vector<Tetra> filling = {};
};

// Where and when it was settled whose place on a shape is whose.
struct Settling {
  std::vector<Vec3d> position;  // by agent [m]; empty: where and when the swarm starts
  double time = 0;              // [s]; a path was entered then
};

// Without a box there are no walls.
struct World {
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  std::uint64_t seed = 1;
  double dt = 1.0 / 120;  // of a step [s]
  double time = 0;        // at the start [s]; goals, shapes and events follow it
  double duration = 10;   // of the scene, over which paths without a speed are flown [s]
  int dimensions = 3;     // 2: z stays 0
  Region box{{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}};
  std::vector<GoalSpec> goals;
  std::vector<PredatorSpec> predators;
  std::vector<Obstacle> obstacles = {};
  std::vector<ShapeInTime> shapes = {};
  std::vector<PathSpec> paths = {};
  WindSpec wind = {};
  std::vector<EventSpec> events = {};  // by increasing time; models' settings are the engine's
};

// Where a goal is at a time [s].
Vec3d GoalPosition(const GoalSpec& goal, double time);

// The surroundings as they are now.
struct Surroundings {
  const World* world = nullptr;
  double time = 0;              // [s]
  std::uint32_t step = 0;       // from 0
  std::vector<GoalSpec> goals;  // with `position` as it is now
  Vec3d wind;                   // [m/s]
  std::span<const Predator> predators;

  double dt() const { return world->dt; }
  bool flat() const { return world->dimensions == 2; }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_WORLD_H_
