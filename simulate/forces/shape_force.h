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

  template <typename T, typename Taper>
  static Share<T> Pair(const Params<T, Taper>& p, const Vec3<T>& dx, const Vec3<T>& /*dv*/) {
    using std::abs;
    using std::exp;
    const T manhattan = abs(dx.x) + abs(dx.y) + abs(dx.z);
    const T share = manhattan / p.sigma;
    const T push = exp(T(T(-0.5) * share * share)) / SoftLength(Dot(dx, dx));
    return {-push * dx, TaperWindow(T(manhattan * manhattan), p.reach, p.taper)};
  }

  template <typename T, typename Taper>
  static Vec3<T> Finish(const Params<T, Taper>& p, const Weighted<T>& sum) {
    return p.gain * Mean(sum);
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FORCES_SHAPE_FORCE_H_
