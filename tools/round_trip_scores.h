// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How much each stage of the round trip (simulate, film, track, reconstruct, fit, replay, film
// again) adds to its final error. The final error is that of the flock that comes out: replayed
// from several moments of the film by what was fitted, and compared with the truth a lead time
// later, in space and in the picture.
//
// Shares are those of error_shares.h: the chain is run again from each stage on, with the truth put
// in for all that comes before it.

#ifndef FLOCKLIFT_TOOLS_ROUND_TRIP_SCORES_H_
#define FLOCKLIFT_TOOLS_ROUND_TRIP_SCORES_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "reconstruct/replay/replay.h"
#include "simulate/camera/camera.h"
#include "simulate/core/observations.h"
#include "simulate/core/options.h"
#include "simulate/core/parameters.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

struct RoundTripOptions {
  double lead = 1;  // [s]
  int starts = 6;
};

template <typename Visitor>
void Describe(Visitor& visit, RoundTripOptions& o) {
  visit("lead", o.lead, {.low = 0.01, .high = 1e4}, "s",
        "how far ahead the replayed flock is compared with the true one");
  visit("starts", o.starts, {.low = 2, .high = 10000}, "",
        "moments of the film that replays start from");
}

// The chain with the truth before `stage`: what its replay starts from and flies by.
struct RoundTripLeg {
  std::string stage;
  Trajectories paths;  // world frame, velocities filled
  Parameters parameters;
  bool has_true_ids = true;  // else animals are told by where they are in the picture
};

// Differences of whole flocks at the lead time, model's noise included; means over the starts.
struct FlockDifference {
  double polarisation = 0;
  double speed = 0;      // of the median, relative
  double neighbour = 0;  // of the median distance to the nearest neighbour, relative
};

struct StageShare {
  std::string stage;
  // Of the chain from this stage on; nothing for the second film, which moves nobody in space.
  std::optional<double> error;  // rms over animals and starts [m]
  double image_error = 0;       // the same in the picture, at most its diagonal [px]
  double share = 0, share_sd = 0;
  double image_share = 0, image_share_sd = 0;
  std::optional<double> coverage;  // of the true animals in view at the starts
  std::optional<FlockDifference> flock;
};

struct RoundTripScores {
  std::vector<StageShare> stages;  // in the chain's order
  double lead = 0;                 // [s]
  int starts = 0;
  int animals = 0;  // compared, over all starts: those that every leg has
  // Of the whole chain, and of flight at its starting velocities.
  double error = 0, straight_on_error = 0;              // [m]
  double image_error = 0, straight_on_image_error = 0;  // [px]

  bool IsUsable() const { return animals > 0; }
};

// The tracks that a film of the flock gives; its frame 1 is the flock's first.
using FilmAgain = std::function<Tracks(const Trajectories& flock)>;

// `legs` in the chain's order. `replay` says how flights step. Without `film_again` the second film
// has no row. Position errors are of noiseless flights: what noise adds is drawn and would count
// twice. Frames as in the truth. Throws std::invalid_argument when the film is shorter than the
// lead time.
RoundTripScores ScoreRoundTrip(const RoundTripOptions& options, const ReplayOptions& replay,
                               const Camera& camera, const Trajectories& truth,
                               const std::vector<RoundTripLeg>& legs, double fps,
                               std::uint64_t seed, int threads, const FilmAgain& film_again = {});

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_ROUND_TRIP_SCORES_H_
