// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a person must know before believing a fit, one sentence each.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_FIT_WARNINGS_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_FIT_WARNINGS_H_

#include "reconstruct/fit/fit.h"

namespace flocklift {

// Median of the positive sd_depth [m]; 0 without any.
double MedianSdDepth(const Trajectories& trajectories);

// Appends to `result->warnings` what `result` calls for. `pull`: share of the unexplained that a
// pull to the middle explains, 0 when walls are part of the model.
void AddWarnings(const FitOptions& options, double pull, double median_sd_depth, FitResult* result);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_FIT_WARNINGS_H_
