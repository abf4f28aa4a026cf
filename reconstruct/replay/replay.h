// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A reconstructed flock, flown on by a model: the state at one frame, run forward through the
// force engine that also makes the synthetic flocks. How soon it parts from the reconstruction says
// how much of the motion the model explains; flying straight on is the model to beat, and the
// growth of a small perturbation of the same flock says how soon any model would part from it. Or
// guided: the model and a pull to the reconstructed paths at once (guided_flight.h). In a scene the
// flock flies among that scene's surroundings, by its steps; tetrahedra that morph fly as they do
// there (reconstruct/fit/departure.h). World frame, z up; metres, seconds.

#ifndef FLOCKLIFT_RECONSTRUCT_REPLAY_REPLAY_H_
#define FLOCKLIFT_RECONSTRUCT_REPLAY_REPLAY_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "simulate/core/options.h"
#include "simulate/core/parameters.h"
#include "simulate/core/progress.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

struct ReplayOptions {
  int frame = 0;
  double duration = 0;
  int count = 0;
  int substeps = 4;
  double alpha = 1;
  double pull_time = 0.5;
  bool noiseless = false;
};

template <typename Visitor>
void Describe(Visitor& visit, ReplayOptions& o) {
  visit("frame", o.frame, {.low = 0}, "",
        "where to start; 0: where those in view are seen longest from, all together");
  visit("duration", o.duration, {.low = 0, .high = 1e5}, "s",
        "how long to fly on; 0: to the reconstruction's last frame");
  visit("count", o.count, {.low = 0, .high = 1e6}, "",
        "animals; 0: those of the frame. More are copies of some, a neighbour's distance aside");
  visit("substeps", o.substeps, {.low = 1, .high = 1000}, "",
        "steps of the engine a frame, where no scene says how many");
  visit(
      "alpha", o.alpha, {.low = 0, .high = 1}, "",
      "share of the model's force; the rest pulls to the reconstructed paths. 1: the model alone");
  visit("pull-time", o.pull_time, {.low = 0.05, .high = 1e3}, "s",
        "how soon that pull brings an animal back to its path");
  visit("noiseless", o.noiseless, {}, "", "leave the model's noise out: fly what it expects");
}

// Root mean square distance from the reconstruction, over the animals that are in both.
struct Divergence {
  double time = 0;             // since the start [s]
  int animals = 0;             // in both
  double model_rms = 0;        // [m]
  double noiseless_rms = 0;    // of the model without its noise: what it expects [m]
  double straight_on_rms = 0;  // of flight at the starting velocity [m]
  // Between this flight and one whose start was moved by kPerturbation per axis; 0 when guided, and
  // of a morph [m].
  double perturbed_rms = 0;
};

inline constexpr double kPerturbation = 1e-3;  // [m]

struct ReplayResult {
  Trajectories replayed;  // frames as in the reconstruction; ids too, copies get ids above them
  int start_frame = 0;
  std::vector<Divergence> divergence;  // by frame, the start left out
};

// Cruising speeds are each animal's mean speed in the reconstruction. Obstacles stand besides what
// the parameters say, in a free flight of a model that avoids them (bswarm, shape, swarm). Throws
// InputError for a model or parameter that does not exist, does not see the obstacles or needs the
// scene,
// std::invalid_argument for a frame without animals.
ReplayResult Replay(const ReplayOptions& options, const Parameters& parameters,
                    const Trajectories& reconstruction, double fps, std::uint64_t seed, int threads,
                    const Progress& progress = {}, const std::vector<ObstacleSpec>& obstacles = {},
                    const std::optional<Scene>& scene = {});

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_REPLAY_REPLAY_H_
