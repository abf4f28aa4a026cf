// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The batch method's model for what the user knows and the image shows: unknowns of the flock,
// their priors, and first guesses of the spreads.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_BATCH_MODEL_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_BATCH_MODEL_H_

#include "reconstruct/initialize/scale_guess.h"
#include "reconstruct/solve/batch_problem.h"

namespace flocklift::internal {

BatchModel MakeModel(const BatchOptions& options, const Knowledge& knowledge,
                     const Segments& segments, const ScaleGuess& guess,
                     const std::optional<Belief>& belief, double fps);

// The guess brought to the speed that another part of the sequence has found.
ScaleGuess WithBelief(const ScaleGuess& guess, const Knowledge& knowledge,
                      const std::optional<Belief>& belief);

// The flock's unknowns at the means of their priors.
Eigen::VectorXd StartOfShared(const BatchModel& model);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_BATCH_MODEL_H_
