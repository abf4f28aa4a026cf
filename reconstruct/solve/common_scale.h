// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The common scale of paths that are known but for it. A scene that grows by a common factor looks
// the same to a camera at rest: depths, speeds and the ratio of size grow along, and of the batch
// method's terms (batch_problem.h) only what is known in metres changes: the priors of speed, size
// and depth, anchors, a second camera, the way of a camera that moves.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_COMMON_SCALE_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_COMMON_SCALE_H_

#include <Eigen/Core>
#include <vector>

#include "reconstruct/solve/batch_problem.h"

namespace flocklift::internal {

// All grow by the factor exp(`log_factor`).
void Grow(double log_factor, const BatchModel& model, std::vector<Bird>* birds,
          Eigen::VectorXd* shared);

// Lets all grow to where these terms, smoothness left out, have their minimum.
void FindCommonScale(const BatchModel& model, std::vector<Bird>* birds, Eigen::VectorXd* shared);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_COMMON_SCALE_H_
