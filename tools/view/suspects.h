// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where tracks may be wrong, from the tracks alone, in order of doubt. Doubt is in [0, 1]:
//   meeting  two tracks come nearer than the larger of their boxes: identities may have been
//            exchanged there. 0.9 exp(-2 d / size), raised towards 1 when exchanging the two would
//            make both paths straighter.
//   jump     the image motion changes by J robust standard deviations of all tracks' changes, and
//            by a good part of a size: 0.75 (1 - 8 / J) for J > 8
//   gap      G frames in a row are interpolated: 0.7 (1 - exp(-G / 8))
//   start, end   a track begins or ends in the middle of the picture and of the film: 0.5 far from
//            the edge, falling to 0 at one size from it
// Where the same tracks give several within half a second, the one of most doubt stands.

#ifndef FLOCKLIFT_TOOLS_VIEW_SUSPECTS_H_
#define FLOCKLIFT_TOOLS_VIEW_SUSPECTS_H_

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "simulate/core/io.h"
#include "simulate/core/observations.h"
#include "simulate/core/progress.h"
#include "tools/view/cut.h"

namespace flocklift {

struct Suspect {
  int frame = 0;
  Id id = 0;
  Id other_id = 0;   // of a meeting; 0: none
  std::string what;  // "meeting", "jump", "gap", "start", "end"; or the tracker's word
  double doubt = 0;  // in [0, 1]
};

// At most `most` of them, most doubt first; equal doubt by frame, then id. `alive` may throw, to
// end it.
std::vector<Suspect> FindSuspects(const TrackList& tracks, double image_width, double image_height,
                                  const Progress& alive = {}, std::size_t most = 500);

// The tracker's own list, `figures.suspicious` of its summary, in its order; doubt is its chance of
// a mistake. What a correction has dealt with is not in it: its tracks within half a second of it,
// two that were joined, one that was deleted. Later doubts follow the ids that swaps and joins
// gave.
std::vector<Suspect> SuspectsOfTracker(const nlohmann::ordered_json& list,
                                       const std::vector<Correction>& corrections);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_SUSPECTS_H_
