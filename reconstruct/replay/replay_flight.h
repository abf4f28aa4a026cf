// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The flights of a replay (replay.h), a frame at a time: by the engine from the state of the start,
// or pulled to the reconstructed paths, or, of tetrahedra that morph, by the engine from the start
// of their scene. World frame, z up; metres, seconds.

#ifndef FLOCKLIFT_RECONSTRUCT_REPLAY_REPLAY_FLIGHT_H_
#define FLOCKLIFT_RECONSTRUCT_REPLAY_REPLAY_FLIGHT_H_

#include <memory>
#include <vector>

#include "reconstruct/fit/departure.h"
#include "reconstruct/fit/term_surroundings.h"
#include "simulate/core/parameters.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

// The flock at the start: its animals, then copies of some.
struct ReplayStart {
  int frame = 0;
  std::vector<Id> id;
  std::vector<Vec3d> position, velocity;
  std::vector<double> cruising_speed;
  std::vector<Id> source;     // whose path each animal follows when guided
  std::vector<Vec3d> offset;  // ... and how far aside [m]
};

class ReplayFlight {
 public:
  virtual ~ReplayFlight() = default;
  // By the animals of the start.
  virtual FlockState NextFrame() = 0;
};

// By the engine, the model alone.
std::unique_ptr<ReplayFlight> FlyFreely(const std::vector<Id>& ids, const Departure& from,
                                        int substeps, int threads);

// By model and pull at once (guided_flight.h). All references live as long as the flight.
std::unique_ptr<ReplayFlight> FlyPulled(const Parameters& parameters,
                                        const TermSurroundings& around, double alpha,
                                        double pull_time, int substeps,
                                        const Trajectories& reconstruction,
                                        const ReplayStart& start, double fps);

// From the scene's start, by the tetrahedra that the animals are nearest to up to the start; moves
// the start's positions and velocities there.
std::unique_ptr<ReplayFlight> FlyFromSceneStart(const Departures& departures, std::uint64_t seed,
                                                int threads, const Trajectories& reconstruction,
                                                double fps, ReplayStart* start);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_REPLAY_REPLAY_FLIGHT_H_
