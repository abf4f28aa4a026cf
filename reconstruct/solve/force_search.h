// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The search for paths and forces together (coupled_flock.h), from the batch solution on. Their
// cost has many minima: depths that are wrong make all of a neighbour's influence look weaker than
// it is, and weak forces leave them wrong; who of two neighbours is in front hardly shows in how
// they push each other sideways. So it is annealed: noise falls, from the batch method's
// accelerations to so little that animals all but obey the forces of usual birds, and then both are
// let go to what the paths say. What was found is annealed once more, from where it is.
// Without sizes the batch solution hardly knows who is in front. Before, animals are drawn to the
// flock's mean depth and pass through each other, for separation stays weak until noise is low:
// that finds a better order, but paths that suit other forces, which the last annealing mends.
// From the most probable solution on, animals are tried at other depths (depth_moves.h). Where an
// animal is in other solutions tells how open the search leaves its depth.
// (graduated non-convexity: Blake and Zisserman, Visual Reconstruction, 1987, ch. 7)

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
