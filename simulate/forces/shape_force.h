// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Shape force of Chen et al. 2019, eq. 5 (equations.md, section 6): spreads animals that share a
// shape.
//   a_i = gain mean_j( w_j (x_i - x_j) / |x_i - x_j| exp(-M_ij^2 / (2 sigma^2)) ),
//   M_ij the Manhattan distance, w_j = TaperWindow(M_ij; reach, taper)
// With the sample spacing h = sqrt(A/N) of the shape, the published reach is 2 h and sigma 0.9 h.

#ifndef FLOCKLIFT_SIMULATE_FORCES_SHAPE_FORCE_H_
#define FLOCKLIFT_SIMULATE_FORCES_SHAPE_FORCE_H_

#include <cmath>

#include "simulate/forces/term.h"
#include "simulate/forces/window.h"

namespace flocklift {

struct ShapeForce {
  template <typename T, typename Taper = T>
  struct Params {
    T gain;       // [m/s^2]
    T reach;      // k sqrt(A/N) [m]
    T sigma;      // omega sqrt(A/N), > 0 [m]
    Taper taper;  // width of the window's edge [m], or HardEdge
  };

  // exp(-y) for y >= 0: a Taylor polynomial at y/32, squared five times. The same arithmetic for
  // all scalars, so that all kernels give the same bytes; within 1e-10 of exp where the published
  // force is not 0 (y < 2.5), and within 1e-5 everywhere.
  template <typename T>
  static T Fall(const T& y) {
    const T clamped = select(y < T(16.0), y, T(16.0));
    const T u = T(-1.0 / 32) * clamped;
    const T v = u * u;  // three short chains instead of a long one
    const T low = T(1.0) + u, middle = T(1.0 / 2) + T(1.0 / 6) * u,
            high = T(1.0 / 24) + T(1.0 / 120) * u;
    T sum = low + v * (middle + v * (high + T(1.0 / 720) * v));
    for (int k = 0; k < 5; ++k) sum = sum * sum;
    return sum;
  }

  template <typename T, typename Taper>
  static Share<T> Pair(const Params<T, Taper>& p, const Vec3<T>& dx, const Vec3<T>& /*dv*/) {
    using std::abs;
    const T manhattan = abs(dx.x) + abs(dx.y) + abs(dx.z);
    const T share = manhattan * (T(1.0) / p.sigma);
    const T push = Fall(T(T(0.5) * share * share)) * InverseLength(Dot(dx, dx));
    return {-push * dx, TaperWindow(T(manhattan * manhattan), p.reach, p.taper)};
  }

  template <typename T, typename Taper>
  static Vec3<T> Finish(const Params<T, Taper>& p, const Weighted<T>& sum) {
    return p.gain * Mean(sum);
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FORCES_SHAPE_FORCE_H_
