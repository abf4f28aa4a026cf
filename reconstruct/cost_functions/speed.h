// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Speed: an animal keeps near its own mean speed m. With the velocity over depth, w = v / z,
//   e = log |v| - log m = L + log sqrt(|w|^2 + eps^2) - log m.
// A ratio of speeds, so that the scale of the scene leaves it alone but for L itself.

#ifndef FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_SPEED_H_
#define FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_SPEED_H_

#include <cmath>

#include "reconstruct/cost_functions/path.h"

namespace flocklift {

struct SpeedError {
  static constexpr int kSize = 1;
  double rate = 1;           // knots per second
  double softening = 1e-3;   // eps: keeps the logarithm of a standstill finite [1/s]
  CameraMotion camera = {};  // at the knot

  // c: control points k-1 .. k+1, each (X, Y, L); log_mean_speed in log m/s.
  template <typename T>
  void operator()(const T* c, const T& log_mean_speed, T* error) const {
    Of(StateAtKnot(c, rate), log_mean_speed, error);
  }

  template <typename T>
  void Of(const PathState<T>& q, const T& log_mean_speed, T* error) const {
    using std::log;
    const Vec3<T> w = VelocityOverDepth(q, camera);
    error[0] = q.l + 0.5 * log(Dot(w, w) + softening * softening) - log_mean_speed;
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_SPEED_H_
