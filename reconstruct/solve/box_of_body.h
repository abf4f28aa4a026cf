// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a wingspan tells of the scale: how large a box a bird fills in the views that a sequence
// shows. cost_functions/size.h follows the size from view to view, up to one ratio of the flock;
// a side view shows a body's length where a view from below shows its wings, so what that ratio
// must be depends on the views and on the body:
//   ratio = log (size of a box, body_image.h) - (log size of size.h without a ratio),
// in the mean over sightings. How well length and amplitude of the wingbeat are known (FlockBody)
// gives the ratio its sd. Where gravity is not known the whole
// flock has its up somewhere, anywhere on the sphere: what the ratio differs by from one up to
// another is unknown to all its birds alike, and no number of them lessens it.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_BOX_OF_BODY_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_BOX_OF_BODY_H_

#include <vector>

#include "reconstruct/cost_functions/body_image.h"
#include "reconstruct/solve/batch_problem.h"

namespace flocklift::internal {

// The ratio of such a body in a flock that flies level about `up`, a unit vector: the model's where
// it knows one. Of every `stride`-th knot with a size; 0 where there is none.
double BoxRatio(const BodyShape& body, const Vec3d& up, const BatchModel& model,
                const std::vector<Bird>& birds, const Eigen::VectorXd& shared, int stride);

// The same for a body of which no more is known than that it is a bird's, with its sd; `other_sd`
// is what else makes boxes larger or smaller than this.
Uncertain ExpectedBoxRatio(const BatchModel& model, const std::vector<Bird>& birds,
                           const Eigen::VectorXd& shared, double other_sd);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_BOX_OF_BODY_H_
