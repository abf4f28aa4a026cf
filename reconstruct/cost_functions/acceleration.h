// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Smoothness: the acceleration is a Markov process. What enters is acceleration / z times a fixed
// reference depth of the animal, so that it cannot be lowered by shrinking the scene:
//   e = z_ref (a / z)   [m/s^2], three components in camera axes.

#ifndef FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_ACCELERATION_H_
#define FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_ACCELERATION_H_

#include "reconstruct/cost_functions/path.h"

namespace flocklift {

struct AccelerationError {
  static constexpr int kSize = 3;
  double rate = 1;             // knots per second
  double reference_depth = 1;  // [m]
  CameraMotion camera = {};    // at the knot

  // c: control points k-1 .. k+1, each (X, Y, L).
  template <typename T>
  void operator()(const T* c, T* error) const {
    Of(StateAtKnot(c, rate), error);
  }

  template <typename T>
  void Of(const PathState<T>& q, T* error) const {
    const Vec3<T> a = AccelerationOverDepth(q, camera);
    error[0] = reference_depth * a.x;
    error[1] = reference_depth * a.y;
    error[2] = reference_depth * a.z;
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_ACCELERATION_H_
