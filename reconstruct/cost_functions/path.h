// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The path of one animal as the solver's unknowns: X = x/z, Y = y/z, L = log z of its position in
// the camera frame, each a uniform cubic B-spline of time with knots every h seconds. At knot k
//   q = (c_{k-1} + 4 c_k + c_{k+1}) / 6,  q' = (c_{k+1} - c_{k-1}) / 2h,
//   q'' = (c_{k+1} - 2 c_k + c_{k-1}) / h^2
// With n = (X, Y, 1) the position is z n, and
//   velocity / z     = n' + L' n
//   acceleration / z = n'' + 2 L' n' + (L'' + L'^2) n
// do not contain z at all: a static camera sees no scale, and neither do these.

#ifndef FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_PATH_H_
#define FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_PATH_H_

#include <array>

#include "simulate/core/vec3.h"

namespace flocklift {

// Weights of control points k-1 .. k+2 at fraction s in [0, 1] of the interval after knot k.
constexpr std::array<double, 4> SplineWeights(double s) {
  const double r = 1 - s;
  return {r * r * r / 6, (4 - 6 * s * s + 3 * s * s * s) / 6, (4 - 6 * r * r + 3 * r * r * r) / 6,
          s * s * s / 6};
}

// First derivative of the weights by time, times h.
constexpr std::array<double, 4> SplineSlopes(double s) {
  const double r = 1 - s;
  return {-r * r / 2, s * (3 * s - 4) / 2, r * (4 - 3 * r) / 2, s * s / 2};
}

// q, q', q'' at one time.
template <typename T>
struct PathState {
  T x, y, l;        // x/z, y/z, log z
  T dx, dy, dl;     // [1/s]
  T ddx, ddy, ddl;  // [1/s^2]
};

// `c` holds control points k-1, k, k+1, each (X, Y, L); rate = 1 / h.
template <typename T>
PathState<T> StateAtKnot(const T* c, double rate) {
  const auto value = [&](int a) { return (c[a] + 4.0 * c[a + 3] + c[a + 6]) * (1.0 / 6.0); };
  const auto slope = [&](int a) { return (c[a + 6] - c[a]) * (0.5 * rate); };
  const auto curve = [&](int a) { return (c[a] - 2.0 * c[a + 3] + c[a + 6]) * (rate * rate); };
  return {value(0), value(1), value(2), slope(0), slope(1), slope(2), curve(0), curve(1), curve(2)};
}

// Camera axes [1/s].
template <typename T>
Vec3<T> VelocityOverDepth(const PathState<T>& q) {
  return {q.dx + q.dl * q.x, q.dy + q.dl * q.y, q.dl};
}

// Camera axes [1/s^2].
template <typename T>
Vec3<T> AccelerationOverDepth(const PathState<T>& q) {
  const T k = q.ddl + q.dl * q.dl;
  return {q.ddx + 2.0 * q.dl * q.dx + k * q.x, q.ddy + 2.0 * q.dl * q.dy + k * q.y, k};
}

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_PATH_H_
