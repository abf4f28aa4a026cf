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

#include <optional>
#include <string>
#include <vector>

#include "simulate/core/observations.h"

namespace flocklift {

struct Suspect {
  int frame = 0;
  Id id = 0;
  Id other_id = 0;   // of a meeting; 0: none
  std::string what;  // "meeting", "jump", "gap", "start", "end"
  double doubt = 0;  // in [0, 1]
};

// At most `most` of them, most doubt first; equal doubt by frame, then id.
std::vector<Suspect> FindSuspects(const Tracks& tracks, double image_width, double image_height,
                                  std::size_t most = 500);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_SUSPECTS_H_
