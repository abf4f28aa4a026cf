// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A person's corrections, applied to finished tracks in the order in which they stand:
//   swap A B F           from frame F on, A and B change places
//   split A F            A's rows from frame F on become a new animal
//   join A B             B's rows become A's; what lies between is interpolated
//   delete A [F L]       A's rows go, all or those of frames F to L
//   pin A F X Y          A is at (X, Y) in frame F; its path between the pins before and after is
//                        linked anew (relink.h), a gap beside it is interpolated
//   add F X Y            a new animal, seen in frame F at (X, Y)
// New ids follow the largest id so far. A pinned or added row has confidence 1 and no shape.

#ifndef FLOCKLIFT_TRACK_CORRECT_H_
#define FLOCKLIFT_TRACK_CORRECT_H_

#include <span>
#include <string>

#include "simulate/core/io.h"
#include "simulate/core/observations.h"

namespace flocklift {

// `file` names the corrections' file in messages; `frame_count` is the footage's. Throws
// InputError with the line for an id or frame that does not exist, or a join of two tracks that
// were both seen in one frame. Tracks that lose all their rows disappear. `next_id`, if given, is
// the least id for a new animal, and becomes the one after those used: whoever applies corrections
// to a few tracks of many knows the others' ids.
void ApplyCorrections(std::span<const Correction> corrections, const std::string& file,
                      int frame_count, Tracks* tracks, Id* next_id = nullptr);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_CORRECT_H_
