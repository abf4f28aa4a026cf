// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Windows with a soft edge. The published rules cut off hard, [r < radius], and a hard edge has no
// derivative with respect to its radius; every window here takes the width of its edge:
//   s(u) = u^2 (3 - 2u), u clamped to [0, 1]     (smooth step: s(0) = 0, s(1) = 1, s' = 0 at both)
//   TaperWindow = s((radius - r) / taper + 1/2)  centred on the radius: 1/2 there
// It is 1 up to radius - taper/2 and 0 from radius + taper/2 on; taper 0 is the published form.

#ifndef FLOCKLIFT_SIMULATE_FORCES_WINDOW_H_
#define FLOCKLIFT_SIMULATE_FORCES_WINDOW_H_

#include <cmath>

#include "simulate/core/vec3.h"

namespace flocklift {

// A taper that is known to be 0 when the code is compiled: no square root, no division.
struct HardEdge {};

// Added under square roots [m^2]: distances below a micrometre have a finite slope.
inline constexpr double kSoftening = 1e-12;

// |dx| with a finite slope at 0, from its square.
template <typename T>
T SoftLength(const T& squared) {
  using std::sqrt;
  return sqrt(squared + T(kSoftening));
}

// 1 / |dx|, finite at 0, from its square.
template <typename T>
T InverseLength(const T& squared) {
  return T(1.0) / SoftLength(squared);
}

// [x > 0] with an edge `taper` wide, in the unit of x, centred on 0.
template <typename T>
T SoftStep(const T& x, const T& taper) {
  const T zero(0.0), one(1.0);
  const T width = select(taper > zero, taper, one);
  const T raw = x / width + T(0.5);
  const T u = select(raw < zero, zero, select(raw > one, one, raw));
  return select(taper > zero, u * u * (T(3.0) - T(2.0) * u), select(x > zero, one, zero));
}
template <typename T>
T SoftStep(const T& x, HardEdge /*taper*/) {
  return Where(x > T(0.0), T(1.0));
}

// [r < radius] of a squared distance r^2 [m^2].
template <typename T>
T TaperWindow(const T& squared_distance, const T& radius, const T& taper) {
  const T hard = Where(squared_distance < radius * radius, T(1.0));
  return select(taper > T(0.0), SoftStep(radius - SoftLength(squared_distance), taper), hard);
}
template <typename T>
T TaperWindow(const T& squared_distance, const T& radius, HardEdge /*taper*/) {
  return Where(squared_distance < radius * radius, T(1.0));
}

// [r <= radius]: as TaperWindow, but a hard edge belongs to the inside.
template <typename T>
T ClosedTaperWindow(const T& squared_distance, const T& radius, const T& taper) {
  const T hard = Where(squared_distance <= radius * radius, T(1.0));
  return select(taper > T(0.0), SoftStep(radius - SoftLength(squared_distance), taper), hard);
}
template <typename T>
T ClosedTaperWindow(const T& squared_distance, const T& radius, HardEdge /*taper*/) {
  return Where(squared_distance <= radius * radius, T(1.0));
}

// The larger of two, rounded where they differ by less than `taper`: max(a, b) + h^2 taper / 4,
// h = max(0, 1 - |a - b| / taper). Once differentiable; taper 0 is the plain maximum.
template <typename T>
T SoftMax(const T& a, const T& b, const T& taper) {
  const T zero(0.0), one(1.0);
  const T width = select(taper > zero, taper, one);
  const T larger = select(a > b, a, b);
  const T difference = select(a > b, a - b, b - a);
  const T raw = one - difference / width;
  const T h = select(raw > zero, raw, zero);
  return larger + select(taper > zero, T(0.25) * width * h * h, zero);
}
template <typename T>
T SoftMin(const T& a, const T& b, const T& taper) {
  return -SoftMax(T(-a), T(-b), taper);
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FORCES_WINDOW_H_
