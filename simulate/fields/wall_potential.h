// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Noise that does not blow through walls (equations.md, section 4, with the mended sentence: a
// falls to 0 at the surface). With the distance d to the wall and its unit normal n = grad d /
// |grad d|,
//   N' = a N + (1 - a)(n . N) n,     a = ramp(d / reach)
//   ramp(u) = 15/8 u - 10/8 u^3 + 3/8 u^5 on [0, 1], 0 below, 1 above
// On the wall only the normal part of N is left, and the curl of a normal field has no normal part.
// The curl is analytic (H: Hessian of d, s = n . N):
//   curl N' = a curl N + (a'/reach) grad d x N + (1 - a) ( grad s x n + s curl n )
//   grad s = ( H N - s H n ) / |grad d| + (grad N)^T n,     curl n = n x H n / |grad d|

#ifndef FLOCKLIFT_SIMULATE_FIELDS_WALL_POTENTIAL_H_
#define FLOCKLIFT_SIMULATE_FIELDS_WALL_POTENTIAL_H_

#include <cmath>

#include "simulate/core/vec3.h"
#include "simulate/fields/curl_noise.h"

namespace flocklift {

template <typename T>
T Ramp(const T& u) {
  const T zero(0.0), one(1.0);
  const T x = select(u < zero, zero, select(u > one, one, u));
  const T x2 = x * x;
  return T(0.125) * x * (T(15.0) + x2 * (T(3.0) * x2 - T(10.0)));
}
template <typename T>
T RampSlope(const T& u) {
  const T zero(0.0), one(1.0);
  const T x = select(u < zero, one, select(u > one, one, u));  // the slope at 1 is 0
  const T y = one - x * x;
  return T(1.875) * y * y;
}

// The distance to a wall around a point, negative inside [m]; any smooth function that is 0 on the
// wall and grows away from it does.
template <typename T>
struct WallDistance {
  T value;
  Vec3<T> gradient;
  Vec3<T> hessian[3];  // rows, symmetric [1/m]
};

// The velocity curl N' [m/s]. `reach` [m] is above 0; where grad d is 0 there is no normal, and the
// field is a curl N.
template <typename T>
Vec3<T> CurlNearWall(const PotentialSample<T>& noise, const WallDistance<T>& wall, const T& reach) {
  using std::sqrt;
  const T zero(0.0), one(1.0);
  const T squared = SquaredNorm(wall.gradient);
  const auto has_normal = squared > T(1e-12);
  const T length = sqrt(select(has_normal, squared, one));
  const T inverse = select(has_normal, one / length, zero);
  const Vec3<T> n = wall.gradient * inverse;
  const auto hessian_times = [&wall](const Vec3<T>& v) -> Vec3<T> {
    return {Dot(wall.hessian[0], v), Dot(wall.hessian[1], v), Dot(wall.hessian[2], v)};
  };
  const Vec3<T> bend = hessian_times(n);
  const T s = Dot(n, noise.value);
  const Vec3<T> grad_s = (hessian_times(noise.value) - bend * s) * inverse +
                         noise.gradient[0] * n.x + noise.gradient[1] * n.y +
                         noise.gradient[2] * n.z;
  const T u = wall.value / reach;
  const T a = Ramp(u), slope = RampSlope(u) / reach;
  return Curl(noise) * a + Cross(wall.gradient, noise.value) * slope +
         (Cross(grad_s, n) + Cross(n, bend) * (s * inverse)) * (one - a);
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FIELDS_WALL_POTENTIAL_H_
