// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Reprojection: (x(t) - observed) / sd for either normalised coordinate, where x(t) is the spline's
// value between two knots. Linear in the four control points around t.

#ifndef FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_REPROJECTION_H_
#define FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_REPROJECTION_H_

#include <cstddef>

#include "reconstruct/cost_functions/path.h"

namespace flocklift {

struct ReprojectionError {
  std::array<double, 4> weights;  // SplineWeights at the time of the sighting
  Vec2d ray;                      // (x/z, y/z) as seen
  double sd = 1;                  // of either coordinate

  // Parameters: control points k-1 .. k+2, each (X, Y, L). Two residuals.
  template <typename T>
  bool operator()(const T* c, T* residuals) const {
    T x(0.0), y(0.0);
    for (std::size_t a = 0; a < 4; ++a) {
      x += weights[a] * c[3 * a];
      y += weights[a] * c[3 * a + 1];
    }
    residuals[0] = (x - ray.x) / sd;
    residuals[1] = (y - ray.y) / sd;
    return true;
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_REPROJECTION_H_
