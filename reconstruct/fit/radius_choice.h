// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Radii of boids that nobody gave, chosen from the motion. A regression frees weights alone, and
// with wrong radii or a hard edge where there is none these come out wrong: an animal that crosses
// the edge changes its acceleration at once, which the data do not show, and the weight falls to
// nearly 0. What that leaves unexplained lasts, passes for the noise's memory, and takes slow terms
// with it, such as the pull to a goal. So d_s, d_v and the width of their edge, as a share of d_s,
// are sought on a grid, then beside the best: least is to be the error of flights a second on,
//   E^2 of window_choice.h
// in the time before that which predictions are held to. Others than the model's are taken when E^2
// falls by a tenth, in quick fits (fewer rows, the goal where the first one found it, or in the
// middle) and then in the one that is asked for. What a fit leaves over tells less: with wrong
// radii it may be small from frame to frame, or pass for noise that lasts. Not of a reconstruction,
// whose window is chosen so.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_RADIUS_CHOICE_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_RADIUS_CHOICE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "reconstruct/fit/fit.h"

namespace flocklift::internal {

// The problem with the radii chosen, and a sentence for each, and with a goal to be sought where
// these need one to fly better; as it is where one is given or free, or the model knows none.
FitProblem ChooseRadii(const FitOptions& options, const FitProblem& problem,
                       const Trajectories& trajectories, double fps, std::uint64_t seed,
                       int threads, std::vector<std::string>* notes);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_RADIUS_CHOICE_H_
