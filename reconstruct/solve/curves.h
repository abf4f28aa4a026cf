// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How animals turn as far as is known now, for their lean (cost_functions/size.h): at every knot
// the mean acceleration of 0.3 s before and after it, over gravity's.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_CURVES_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_CURVES_H_

#include <vector>

#include "reconstruct/solve/batch_problem.h"

namespace flocklift::internal {

void UpdateCurves(const BatchModel& model, std::vector<Bird>* birds);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_CURVES_H_
