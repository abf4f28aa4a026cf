// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Flights by the engine that simulated statistics are of. They start from the flock as it is in its
// fullest frame, and with a scene in that scene's surroundings: its meshes, paths, goals,
// obstacles, predators and steps. Tetrahedra that morph are where the scene's start and the time
// put them, and which place on a shape is whose was settled at a swarm's start: these fly from the
// scene's own start, the swarm's drawn anew with each seed, and nothing of the data is needed.
// World frame, z up; metres, seconds.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_ENGINE_FLIGHT_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_ENGINE_FLIGHT_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reconstruct/fit/fit.h"
#include "reconstruct/fit/motion_statistics.h"
#include "simulate/flock/engine.h"

namespace flocklift::internal {

// The model that moves the scene's species of that name, with the scene's numbers. Throws
// InputError for a scene that has none.
const SpeciesSpec& SpeciesOf(const Scene& scene, const std::string& model);

// A scene at its start: its surroundings, and the species that moves by the model, with its animals
// where the scene puts them.
struct SceneStart {
  World world;
  Swarm swarm;
  int substeps = 1;  // a frame of the data
};
// Throws as SpeciesOf does.
SceneStart StartIn(const Scene& scene, const std::string& model, double fps);

// Frame by frame, from the first to the last.
std::vector<FramePositions> FramesOf(const Trajectories& trajectories);

struct FlightStart {
  World world;
  Swarm swarm;
  std::size_t first = 0, frames = 0;  // of the data's, that flights are compared with
  int substeps = 1;                   // steps a frame
  std::int64_t steps_before = 0;      // from the start to the first of these frames
  std::optional<Scene> drawn;         // whose start is drawn anew; nothing: all start alike
  std::vector<Vec3d> velocity_doubt;  // times N(0, 1), new with each seed, added at the start
};

// `frames`: all of the data's, in a row.
FlightStart MakeFlightStart(const FitOptions& options, const FitProblem& problem,
                            const std::vector<FramePositions>& frames, Trajectories trajectories,
                            double fps);

// Everybody in each frame of the start, predators left out; nothing where the model's numbers are
// out of range or the flock flies apart. `own_speed` multiplies the cruising speeds.
std::optional<std::vector<FramePositions>> Fly(const FlightStart& start, const ModelSpec& model,
                                               double own_speed, std::uint64_t seed);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_ENGINE_FLIGHT_H_
