// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The search for paths and forces together (coupled_flock.h), from the batch solution on. Their
// cost has many minima: depths that are wrong make all of a neighbour's influence look weaker than
// it is, and weak forces leave them wrong; animals that hold each other's places cannot pass, for
// separation keeps them apart. So it is sought from several starts:
//   fitted    the batch solution, with the forces that explain it best
//   annealed  animals drawn towards the flock's mean depth, with the forces of usual birds; their
//             noise falls below what it will be, then separation grows to what it is
// From the most probable of them on, animals are tried at other depths (depth_moves.h).

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_FORCE_SEARCH_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_FORCE_SEARCH_H_

#include "reconstruct/solve/batch_solver.h"
#include "reconstruct/solve/dynamics.h"
#include "reconstruct/solve/followed_flock.h"

namespace flocklift::internal {

FollowedFlock FollowForces(const DynamicsOptions& options, const BatchState& batch);

// Goes on with what is known of forces and noise.
void Settle(const BatchModel& model, FollowedFlock* flock);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_FORCE_SEARCH_H_
