// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a fit settles before it begins: speed limits that let the flock fly, the frames to use.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_FIT_SETUP_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_FIT_SETUP_H_

#include <string>
#include <vector>

#include "reconstruct/fit/fit.h"
#include "reconstruct/fit/observed_flock.h"

namespace flocklift {

// Speed limits that the caller did not give must let the observed flock fly.
void WidenSpeedLimits(const FitProblem& problem, const ObservedFlock& flock, ModelSpec* model,
                      std::vector<std::string>* warnings);

double MeanSpeed(const ObservedFlock& flock);  // over animals and frames [m/s]

// The frames to make rows of: all, or every stride-th with those before it that it needs.
std::vector<int> Middles(const ObservedFlock& flock, int window, int stride);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_FIT_SETUP_H_
