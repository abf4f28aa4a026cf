// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Animals at other depths than where a search (force_search.h) has left them. Each has several
// depths at which it would stay as long as all others do: it is put nearer and farther and comes to
// rest among them (one_animal.h). Where that is more probable it stays there. Where it is less so
// by little, the others may only have to make room: the whole flock settles then, and what is more
// probable is kept. (Iterated local search: Lourenco, Martin and Stutzle, 2003.)

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_DEPTH_MOVES_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_DEPTH_MOVES_H_

#include "reconstruct/solve/followed_flock.h"

namespace flocklift::internal {

// `flock` has settled, and is never less probable after it. Returns how many animals were moved.
int MoveDepths(const BatchModel& model, FollowedFlock* flock);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_DEPTH_MOVES_H_
