// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The exact union of convex polygons in the image, as trapezoids with horizontal sides that do not
// overlap: every corner and every crossing of two edges begins a new strip, and inside a strip the
// covered intervals end on the same edges throughout. Area, moments and pixel coverage then have
// closed forms.

#ifndef FLOCKLIFT_SIMULATE_RENDER_SILHOUETTE_H_
#define FLOCKLIFT_SIMULATE_RENDER_SILHOUETTE_H_

#include <span>
#include <vector>

#include "simulate/core/observations.h"
#include "simulate/core/vec3.h"
#include "simulate/render/convex_polygon.h"

namespace flocklift {

// Between y = top and y = bottom, from the left edge to the right edge [px].
struct Trapezoid {
  double top, bottom;
  double left_at_top, left_at_bottom;
  double right_at_top, right_at_bottom;
};

struct Silhouette {
  std::vector<Trapezoid> trapezoids;

  void Shift(const Vec2d& offset);
};

Silhouette UnionOf(std::span<const ConvexPolygon> polygons);

// Area [px^2], centroid [px] and central second moments [px^2], by integrals over the trapezoids.
struct SilhouetteMoments {
  double area = 0;
  Vec2d centroid;
  double xx = 0, xy = 0, yy = 0;
};
SilhouetteMoments MomentsOf(const Silhouette& silhouette);

// Four standard deviations along the axes, as in shapes files.
Shape ShapeOf(const SilhouetteMoments& moments);

// The smallest upright box around it; an empty box at the origin for an empty silhouette.
Box BoundsOf(const Silhouette& silhouette);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_RENDER_SILHOUETTE_H_
