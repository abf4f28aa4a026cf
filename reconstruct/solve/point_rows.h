// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Residuals of the batch method that look at an animal's path at single times, one by one: where
// the cameras see it, where somebody knows it to be, and what keeps it within bounds.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_POINT_ROWS_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_POINT_ROWS_H_

#include "reconstruct/solve/batch_problem.h"
#include "reconstruct/solve/terms.h"

namespace flocklift::internal {

// (x(t) - ray) / ray_sd for either coordinate (cost_functions/reprojection.h); derivatives only
// when asked.
void TakeReprojections(const Bird& bird, bool derivatives, const RowSink& take);

// The same in the picture of the second camera, with q = view_from_ref * (z n):
//   (q_x / q_z - ray_x) / ray_sd,  (q_y / q_z - ray_y) / ray_sd
// A position behind that camera has no residual.
void TakeViews(const Bird& bird, const RowSink& take);

// (z n - position) / sd, three coordinates.
void TakeAnchors(const Bird& bird, const RowSink& take);

// Soft walls at near and far.
void TakeBounds(const BatchModel& model, const Bird& bird, const RowSink& take);

// Nobody flies at several times the flock's speed: keeps the velocity of the shortest sighting
// proper. Linear in the control points.
void TakeAnyVelocity(const BatchModel& model, const Bird& bird, const RowSink& take);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_POINT_ROWS_H_
