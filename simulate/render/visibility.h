// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How much of an animal surfaces leave to be seen: of the pixels that its silhouette covers, by
// their share, the samples in which no surface is nearer than the animal.

#ifndef FLOCKLIFT_SIMULATE_RENDER_VISIBILITY_H_
#define FLOCKLIFT_SIMULATE_RENDER_VISIBILITY_H_

#include "simulate/render/body.h"
#include "simulate/render/depth_buffer.h"

namespace flocklift {

// In [0, 1]; 1 when nothing of the animal is in the image, which has the size of the buffer.
double VisibleShare(const ProjectedBody& body, const DepthBuffer& surfaces);

// The same for an animal too small to have a shape: of the four pixels about `center`.
double VisibleShare(const Vec2d& center, double depth, const DepthBuffer& surfaces);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_RENDER_VISIBILITY_H_
