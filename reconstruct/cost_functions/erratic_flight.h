// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Speed of animals that keep none: the velocity is normal in every direction with sd s (Maxwell's
// distribution of speeds, of mean m = s sqrt(8 / pi)). Were it held near m, what the image does not
// show would be made up by flight along the line of sight. So the part across, which the image
// shows, and the part along it each have an error of their own. With w = v / z and the unit ray n,
//   e_across = L + log |w - (w . n) n| - (log m - 0.41),   e_along = exp(L - log m) (w . n):
// the speed across has Rayleigh's distribution, whose logarithm has sd 0.64 (pi / sqrt(24)) about
// log s + (log 2 - 0.577) / 2; along it the sd is s / m = 0.63.

#ifndef FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_ERRATIC_FLIGHT_H_
#define FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_ERRATIC_FLIGHT_H_

#include <cmath>

#include "reconstruct/cost_functions/path.h"

namespace flocklift {

inline constexpr double kLogAcrossSd = 0.641, kAlongSd = 0.627;

struct ErraticFlightError {
  static constexpr int kSize = 2;  // across, along
  double rate = 1;                 // knots per second
  double softening = 1e-3;         // keeps the logarithm of a standstill finite [1/s]
  CameraMotion camera = {};        // at the knot

  // c: control points k-1 .. k+1, each (X, Y, L); log_mean_speed in log m/s.
  template <typename T>
  void operator()(const T* c, const T& log_mean_speed, T* error) const {
    Of(StateAtKnot(c, rate), log_mean_speed, error);
  }

  template <typename T>
  void Of(const PathState<T>& q, const T& log_mean_speed, T* error) const {
    using std::exp;
    using std::log;
    using std::sqrt;
    constexpr double kLogAcross = -0.409;  // mean of log (speed across / m)
    const Vec3<T> w = VelocityOverDepth(q, camera);
    const T along = (w.x * q.x + w.y * q.y + w.z) / sqrt(q.x * q.x + q.y * q.y + 1.0);
    const T across2 = Dot(w, w) - along * along + softening * softening;
    error[0] = q.l + 0.5 * log(across2) - (log_mean_speed + kLogAcross);
    error[1] = exp(q.l - log_mean_speed) * along;
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_ERRATIC_FLIGHT_H_
