// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The legs of a round trip (round_trip_scores.h) from a folder with truth/, as `simulate` leaves
// it, and result/, as `run` does. The whole chain is what the folder holds; the others are run with
// the options that its summaries state, into
//   round_trip/track/         the truth filmed without noise, blur, haze and clouds, and tracked
//   round_trip/reconstruct/   from the true tracks on
//   round_trip/fit/           from the true positions of the animals in view on
// Then come, from the scene itself, the true parameters with a start seen in true positions, and
// the true start too. A stage whose inputs and options have not changed is not done again.

#ifndef FLOCKLIFT_TOOLS_ROUND_TRIP_CHAIN_H_
#define FLOCKLIFT_TOOLS_ROUND_TRIP_CHAIN_H_

#include <filesystem>
#include <string>
#include <vector>

#include "simulate/camera/camera.h"
#include "simulate/core/scene.h"
#include "tools/command.h"
#include "tools/round_trip_scores.h"

namespace flocklift {

struct RoundTripChain {
  std::vector<RoundTripLeg> legs;  // none when something is missing
  // One sentence for each stage that is missing or cannot be told apart from the next, with the
  // command that makes it where there is one.
  std::vector<std::string> missing;
  std::vector<std::filesystem::path> inputs;  // that were read
  Camera camera;
  Scene scene;
  Trajectories truth;
  double fps = 0;
  ReplayOptions replay;
  double wingspan = 0.7;  // of the animals in the replay's film [m]
};

RoundTripChain RunRoundTripChain(const std::filesystem::path& folder, const CommonOptions& common);

// Films and tracks in `folder`/round_trip/film_again as the chain did.
FilmAgain MakeFilmAgain(const RoundTripChain& chain, const std::filesystem::path& folder,
                        const CommonOptions& common);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_ROUND_TRIP_CHAIN_H_
