// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What an animal sees: a cone about its own heading, blind behind. The weight of a neighbour at dx
// is
//   w = s((cos(angle between heading and dx) - cosine) / taper + 1/2)     (s of window.h)
// so taper 0 is the hard edge, [cos >= cosine]. A blind angle of beta [rad] about the tail is
// cosine = -cos(beta / 2). Without a heading (an animal at rest) every angle counts as a right one.

#ifndef FLOCKLIFT_SIMULATE_FORCES_VIEW_H_
#define FLOCKLIFT_SIMULATE_FORCES_VIEW_H_

#include "simulate/core/vec3.h"
#include "simulate/forces/window.h"

namespace flocklift {

// Eyes all around, known when the code is compiled.
struct AllRound {};

template <typename T, typename Taper = T>
struct ViewCone {
  Vec3<T> heading;  // the animal's own, of length 1 (or 0)
  T cosine;         // of the half angle that it sees
  Taper taper;      // width of the edge, in cosine; or HardEdge
};

// v / |v|, and nearly 0 for what has no direction.
template <typename T>
Vec3<T> SoftUnit(const Vec3<T>& v) {
  return InverseLength(Dot(v, v)) * v;
}

// How much of a neighbour at dx is seen. The hard edge needs no root: it compares squares with
// their signs.
template <typename T>
T Seen(const ViewCone<T, HardEdge>& view, const Vec3<T>& dx) {
  const T zero(0.0);
  const T forward = Dot(view.heading, dx);
  const T ahead = forward * select(forward < zero, -forward, forward);
  const T edge = view.cosine * select(view.cosine < zero, -view.cosine, view.cosine);
  return select(ahead < edge * Dot(dx, dx), zero, T(1.0));
}
template <typename T>
T Seen(const ViewCone<T>& view, const Vec3<T>& dx) {
  const T hard = Seen(ViewCone<T, HardEdge>{view.heading, view.cosine, {}}, dx);
  const T cosine = Dot(view.heading, dx) / SoftLength(Dot(dx, dx));
  return select(view.taper > T(0.0), SoftStep(T(cosine - view.cosine), view.taper), hard);
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FORCES_VIEW_H_
