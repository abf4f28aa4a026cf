// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The path of one animal as the solver's unknowns: X = x/z, Y = y/z, L = log z of its position from
// the camera (initialize/reference_axes.h), each a uniform cubic B-spline of time with knots every
// h seconds. At knot k
//   q = (c_{k-1} + 4 c_k + c_{k+1}) / 6,  q' = (c_{k+1} - c_{k-1}) / 2h,
//   q'' = (c_{k+1} - 2 c_k + c_{k-1}) / h^2
// With n = (X, Y, 1) the position is z n, and
//   velocity / z     = n' + L' n
//   acceleration / z = n'' + 2 L' n' + (L'' + L'^2) n
// do not contain z at all: a static camera sees no scale, and neither do these. Where the camera
// moves the position counts from where it is, in axes that do not turn, and its own velocity and
// acceleration over z come on top: known, in metres, and so a measure of scale.

#ifndef FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_PATH_H_
#define FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_PATH_H_

#include <array>
#include <cmath>

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

// Second derivative of the weights by time, times h^2.
constexpr std::array<double, 4> SplineCurves(double s) { return {1 - s, 3 * s - 2, 1 - 3 * s, s}; }

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

// How the camera moves at one time, in the reference axes (initialize/reference_axes.h).
struct CameraMotion {
  bool moves = false;       // else the rest is zero
  Vec3d place = {};         // from its first place [m]
  Vec3d velocity = {};      // [m/s]
  Vec3d acceleration = {};  // [m/s^2]
};

namespace internal {
// w + of_camera / z
template <typename T>
Vec3<T> PlusCamera(const Vec3<T>& w, const Vec3d& of_camera, const T& log_depth) {
  using std::exp;
  const T inverse = exp(-log_depth);
  return {w.x + inverse * of_camera.x, w.y + inverse * of_camera.y, w.z + inverse * of_camera.z};
}
}  // namespace internal

// Reference axes [1/s].
template <typename T>
Vec3<T> VelocityOverDepth(const PathState<T>& q, const CameraMotion& camera) {
  const Vec3<T> w = {q.dx + q.dl * q.x, q.dy + q.dl * q.y, q.dl};
  return camera.moves ? internal::PlusCamera(w, camera.velocity, q.l) : w;
}

// Reference axes [1/s^2].
template <typename T>
Vec3<T> AccelerationOverDepth(const PathState<T>& q, const CameraMotion& camera) {
  const T k = q.ddl + q.dl * q.dl;
  const Vec3<T> a = {q.ddx + 2.0 * q.dl * q.dx + k * q.x, q.ddy + 2.0 * q.dl * q.dy + k * q.y, k};
  return camera.moves ? internal::PlusCamera(a, camera.acceleration, q.l) : a;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_PATH_H_
