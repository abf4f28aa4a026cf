// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How sure depths are where forces are known: the posterior of the linearised problem
// (coupled_flock.h), widened by what that cannot know,
//   variance = (kUnsure sd)^2 + open^2,
// open: what the search for forces leaves (force_search.h). A slope says nothing beyond the edge
// of a rule, and depths are hardly ever known as sharply as flocks obey rules with hard edges. So
// the force is linearised as it is in the mean over what depths may be (statistical linearisation:
// Gelb, Applied Optimal Estimation, 1974, ch. 6): rules end over a length no shorter than distances
// are unsure. Depths of sd s, each for itself, at distance z move the distance of two by sqrt(2) s
// z along the view and 1/sqrt(3) of it along the line between them, which is as wide as a window of
//   w = sqrt(12) sqrt(2/3) s z = sqrt(8) s z.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_FORCE_POSTERIOR_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_FORCE_POSTERIOR_H_

#include <vector>

#include "reconstruct/solve/followed_flock.h"

namespace flocklift::internal {

// Variances of log depth, the common scale's apart.
struct ForcePosterior {
  std::vector<std::vector<double>> linear;  // at every sighting, by animal; empty: singular
  std::vector<double> open;                 // by animal: squares of what the search leaves

  // Root mean square of all sds.
  double Rms() const;
};

// Settles the flock first; it stays where it is then.
ForcePosterior PosteriorOf(const BatchModel& model, FollowedFlock* flock);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_FORCE_POSTERIOR_H_
