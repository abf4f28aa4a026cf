// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Level flight, where gravity is known: e = sine of the climb angle, the share of the speed that
// is vertical.

#ifndef FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_LEVEL_FLIGHT_H_
#define FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_LEVEL_FLIGHT_H_

#include <cmath>

#include "reconstruct/cost_functions/path.h"

namespace flocklift {

struct LevelFlightError {
  static constexpr int kSize = 1;
  double rate = 1;           // knots per second
  double softening = 1e-3;   // speed over depth below which the angle fades out [1/s]
  Vec3d up_in_cam;           // unit vector
  CameraMotion camera = {};  // at the knot

  // c: control points k-1 .. k+1, each (X, Y, L).
  template <typename T>
  void operator()(const T* c, T* error) const {
    Of(StateAtKnot(c, rate), error);
  }

  template <typename T>
  void Of(const PathState<T>& q, T* error) const {
    using std::sqrt;
    const Vec3<T> w = VelocityOverDepth(q, camera);
    error[0] = (w.x * up_in_cam.x + w.y * up_in_cam.y + w.z * up_in_cam.z) /
               sqrt(Dot(w, w) + softening * softening);
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_LEVEL_FLIGHT_H_
