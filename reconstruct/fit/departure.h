// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where a flight of a fitted model departs from: a state of trajectories, in the surroundings of a
// scene where one is given (its meshes, paths, goals, obstacles, predators, wind and events), else
// in those that were fitted. Walkers of a crowd belong to the goals that they were seen to go to.
// Whose place on a shape is whose was settled when a swarm started. It is settled again from where
// they were first seen, or from where they are, by which they have come nearer to their places:
// the first while a swarm is on its way, the other once it has arrived.
//
// Tetrahedra that morph cannot depart from a state: a place says neither whose place in the target
// a tetrahedron will take nor how far it is along its way. They fly from the scene's start, and an
// animal is taken for the tetrahedron whose path was nearest (NearestPaths). World frame, z up;
// metres, seconds.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_DEPARTURE_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_DEPARTURE_H_

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reconstruct/fit/motion_statistics.h"
#include "simulate/core/parameters.h"
#include "simulate/flock/engine.h"

namespace flocklift {

struct Departure {
  World world;
  Swarm swarm;
  std::vector<std::size_t> place;  // in the swarm, of each animal
};

class Departures {
 public:
  // `seen`: what is known of where animals go. `substeps`: steps a frame where there is no scene.
  // Throws InputError for a scene that no species of which moves by the model, and for a model that
  // needs a scene and has none.
  Departures(const std::optional<Scene>& scene, const Parameters& parameters,
             const Trajectories& seen, double fps, int substeps);

  int substeps() const { return substeps_; }  // a frame
  // With everybody's velocity and cruising speed.
  Departure At(double time, const std::vector<Id>& ids, const std::vector<Vec3d>& position,
               const std::vector<Vec3d>& velocity, const std::vector<double>& cruising_speed) const;
  // Where the scene itself puts its animals, at its own start.
  const World& world() const { return world_; }
  const Swarm& swarm() const { return swarm_; }

 private:
  Settling SettlingOf(double time, const std::vector<Id>& ids,
                      const std::vector<Vec3d>& position) const;

  World world_;
  Swarm swarm_;
  double fps_, seen_time_ = 0;  // of the first frame seen [s]
  double settled_time_ = 0;     // of the scene's start [s]
  int substeps_;
  std::vector<FramePositions> seen_;  // of a crowd, and of a swarm that forms a shape
};

// Why the model flies from no state of trajectories without a scene, in a line; empty when it does.
std::string WhyNoDeparture(const ModelSpec& model);

// Does the model fly from a scene's own start alone?
inline bool DepartsFromSceneStart(const ModelSpec& model) { return model.name == "morph"; }

// For each id the path that is nearest to its own, in the mean over these frames; flown[f] holds
// all paths at the time of seen[f]. Ids that are in none of them have path 0.
std::vector<std::size_t> NearestPaths(const std::vector<Id>& ids,
                                      std::span<const FramePositions> seen,
                                      std::span<const std::vector<Vec3d>> flown);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_DEPARTURE_H_
