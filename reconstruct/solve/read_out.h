// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a solution of the batch method's problem says: where everybody was, and how sure that is.
// Variances are those of the linearised posterior (arrow_system.h).

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_READ_OUT_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_READ_OUT_H_

#include <Eigen/Core>

#include "reconstruct/solve/batch.h"
#include "reconstruct/solve/batch_solver.h"

namespace flocklift::internal {

// Points with the posterior of their depths; the common scale's own sd comes from the posterior of
// the mean log depth of all sightings. Returns the covariance of the flock's unknowns.
Eigen::MatrixXd ReadOut(BatchState* state, BatchSolver* solver, BatchResult* result);

// How well every kind of residual is met, and the spreads as estimated.
void CollectTerms(const BatchState& state, BatchReport* report);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_READ_OUT_H_
