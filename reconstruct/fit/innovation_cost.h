// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the innovations of a sweep (flock_filter.h) say of its parameters and noise, where some of
// them know of a speed limit: these are no Gaussian's.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_INNOVATION_COST_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_INNOVATION_COST_H_

#include <Eigen/Core>

#include "reconstruct/fit/flock_filter.h"

namespace flocklift::internal {

inline Eigen::Vector3d ValueOf(const Innovation& i) { return {i.value[0], i.value[1], i.value[2]}; }
Eigen::Matrix3d CovarianceOf(const Innovation& i);

// -2 log likelihood of the next sweep, with this one's covariances where a limit acted: what the
// scoring descends.
double CostBeside(const FilterSweep& sweep, const FilterSweep& next);

// Mean square of the innovations in units of their covariances, but for those that know of a limit:
// 1 where the noise is what it is taken for, and where there is none.
double MeanSquareOf(const FilterSweep& sweep);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_INNOVATION_COST_H_
