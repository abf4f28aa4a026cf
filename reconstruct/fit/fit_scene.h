// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the scene that a flock was flown in says to a fit: where the walls stand, how many steps a
// frame has, what the force terms feel; and whether the motion can be told from positions at all or
// only by simulating it.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_FIT_SCENE_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_FIT_SCENE_H_

#include <string>

#include "reconstruct/fit/fit.h"
#include "reconstruct/fit/term_surroundings.h"

namespace flocklift::internal {

// The problem with the scene's walls, unless others are given. Throws InputError for a scene that
// no species of which moves by the model, a model of terms alone that has none, and a name to be
// freed that is none of a model with terms.
FitProblem InScene(FitProblem problem);
// The options with the scene's steps a frame of the data.
FitOptions InScene(FitOptions options, const FitProblem& problem, double fps);

TermSurroundings SurroundingsOf(const FitProblem& problem);

// Why accelerations cannot be explained by the state alone, in a line; empty where they can.
std::string WhyNotRegressed(const FitProblem& problem);

// Is this one for simulated statistics? Where nothing is named that is so for models without usable
// derivatives, and in a scene for what regression and state-space estimates do not know.
bool ByStatistics(const FitProblem& problem);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_FIT_SCENE_H_
