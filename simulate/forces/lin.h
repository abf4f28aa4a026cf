// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The rules of Lin's thesis (2019; equations.md, section 2). Position-based: no inertia, a step is
// one frame, all lengths [m].
//   s_n = mean_{|x_i - x_n| <= d_sep} (x_n - x_i) / |x_i - x_n|^(1 + k)
//         k = 0: Algorithm 1 (unit offsets); k = 1: the text (offsets over the squared distance)
//   c_n = mean_{all i != n} (x_i - x_n)
//   target_n = x_n + w_sep s_n + (1 - w_sep) c_n

#ifndef FLOCKLIFT_SIMULATE_FORCES_LIN_H_
#define FLOCKLIFT_SIMULATE_FORCES_LIN_H_

#include <cmath>

#include "simulate/forces/term.h"
#include "simulate/forces/window.h"

namespace flocklift {

struct LinSeparation {
  template <typename T>
  struct Params {
    T radius;    // d_sep [m]
    T exponent;  // k
    T taper;     // width of the window's edge [m]; 0: as published
  };

  template <typename T>
  static Share<T> Pair(const Params<T>& p, const Vec3<T>& dx, const Vec3<T>& /*dv*/) {
    using std::pow;
    const T squared = Dot(dx, dx);
    const T w = ClosedTaperWindow(squared, p.radius, p.taper);
    const T scale = pow(T(squared + T(kSoftening)), T(T(-0.5) * (T(1.0) + p.exponent)));
    return {-scale * dx, w};
  }

  template <typename T>
  static Vec3<T> Finish(const Params<T>& /*p*/, const Weighted<T>& sum) {
    return Mean(sum);
  }
};

// Over all others, whatever their distance.
struct LinCohesion {
  template <typename T>
  struct Params {};

  template <typename T>
  static Share<T> Pair(const Params<T>& /*p*/, const Vec3<T>& dx, const Vec3<T>& /*dv*/) {
    return {dx, T(1.0)};
  }

  template <typename T>
  static Vec3<T> Finish(const Params<T>& /*p*/, const Weighted<T>& sum) {
    return Mean(sum);
  }
};

// Where the rules want an animal at `x` to be one frame later.
template <typename T>
Vec3<T> LinTarget(const Vec3<T>& x, const T& w_sep, const Vec3<T>& separation,
                  const Vec3<T>& cohesion) {
  return x + w_sep * separation + (T(1.0) - w_sep) * cohesion;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FORCES_LIN_H_
