// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the batch method starts: every animal's path with its image positions smoothed and its
// depth searched on a grid.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_BATCH_START_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_BATCH_START_H_

#include "reconstruct/initialize/scale_guess.h"
#include "reconstruct/solve/batch_problem.h"

namespace flocklift::internal {

// Where a time is on the path (of the model, the knots' interval counts).
Bird::Place PlaceAt(const BatchModel& model, const Bird& bird, double time);

// Places the sightings and anchors on knots, smooths the image path, searches the depth.
Bird StartBird(const BatchModel& model, const Knowledge& knowledge, const ScaleGuess& guess,
               const Segment& segment, double fps, int first_frame);

// A solved animal at the same knots with other sightings: its depths and what else is known of it
// stay, the image path is smoothed anew. It has no curves yet.
Bird WithSightings(const BatchModel& model, const Segment& segment, const Bird& solved);

// The depth is searched anew by what is known of the animal and the flock by now. Its speed and
// sizes are taken for twice as certain as they are: where smoothness left a path in a reversal of
// depth, they lead out of it.
void SearchDepthAgain(const BatchModel& model, const ScaleGuess& guess,
                      const Eigen::VectorXd& shared, Bird* bird);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_BATCH_START_H_
