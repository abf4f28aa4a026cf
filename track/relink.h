// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A person says where an animal is in one frame; its path before and after that frame is linked
// anew, between the frames that were pinned earlier (keyframes). Where the pin lies on another
// animal B's row, the two had changed places: A's path turns into B's in the frame f at or before
// the pin in which the exchange costs least,
//   cost(f) = d(A before f -> B from f) + d(B before f -> A from f),
//   d = squared distance of the row from where the motion before leads, in sizes and frames,
// and turns back before the next pinned frame. Where nobody is, rows of A from which the pin cannot
// be reached are given to a new animal.

#ifndef FLOCKLIFT_TRACK_RELINK_H_
#define FLOCKLIFT_TRACK_RELINK_H_

#include <map>
#include <set>

#include "simulate/core/observations.h"

namespace flocklift::internal {

using TrackRows = std::map<int, Detection>;  // by frame

struct Pin {
  int frame = 1;
  Vec2d point;  // [px]
};

// From `frame` on, what was a's is b's.
void SwapRows(int frame, TrackRows* a, TrackRows* b);

// Interpolates between the row of `frame` and the rows before and after it.
void FillBeside(int frame, TrackRows* rows);

// Puts animal `id`, which has rows, to the pin. `pinned` are its frames that were pinned before,
// `next_id` the next free one. A row with the usual box and confidence 1 is there afterwards.
void Relink(Id id, const Pin& pin, const std::set<int>& pinned, std::map<Id, TrackRows>* tracks,
            Id* next_id);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_TRACK_RELINK_H_
