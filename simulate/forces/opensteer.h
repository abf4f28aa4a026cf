// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The rule set of OpenSteer's boids (Reynolds 1999; equations.md, section 1). Each rule has a
// radius and a cone of view of its own, and its result is a direction whatever the number of
// neighbours:
//   a_i = gain unit( sum_j w_j u_ij )
//   separation: u = -dx / |dx|^2     alignment: u = dh     cohesion: u = dx
// dh is the difference of the headings (velocities of length 1), not of the velocities. A neighbour
// counts within `radius` if it is seen, and nearer than `near` even if not. Where edges are soft,
// the force of the last neighbour fades as it leaves: unit is scaled by s(sum_j w_j).

#ifndef FLOCKLIFT_SIMULATE_FORCES_OPENSTEER_H_
#define FLOCKLIFT_SIMULATE_FORCES_OPENSTEER_H_

#include "simulate/forces/term.h"
#include "simulate/forces/view.h"
#include "simulate/forces/window.h"

namespace flocklift {

template <typename T, typename Taper = T>
struct SteerParams {
  T gain;                   // of the rule [m/s^2]
  T radius;                 // [m]
  T near;                   // around the animal: felt without being seen [m]
  Taper taper;              // width of the two edges [m], or HardEdge
  ViewCone<T, Taper> view;  // of the rule
};

// How much a neighbour counts.
template <typename T, typename Taper>
T SteerWeight(const SteerParams<T, Taper>& p, const Vec3<T>& dx) {
  const T squared = Dot(dx, dx);
  const T felt = TaperWindow(squared, p.near, p.taper);
  return TaperWindow(squared, p.radius, p.taper) * (felt + (T(1.0) - felt) * Seen(p.view, dx));
}

template <typename T, typename Taper>
Vec3<T> SteerFinish(const SteerParams<T, Taper>& p, const Weighted<T>& sum) {
  const T one(1.0);
  const T w = select(sum.weight > one, one, sum.weight);
  return (p.gain * (w * w * (T(3.0) - T(2.0) * w))) * SoftUnit(sum.value);
}

struct SteerSeparation {
  template <typename T, typename Taper = T>
  using Params = SteerParams<T, Taper>;

  template <typename T, typename Taper>
  static Share<T> Pair(const SteerParams<T, Taper>& p, const Vec3<T>& dx, const Vec3<T>& /*dh*/) {
    return {(T(-1.0) / (Dot(dx, dx) + T(kSoftening))) * dx, SteerWeight(p, dx)};
  }
  template <typename T, typename Taper>
  static Vec3<T> Finish(const SteerParams<T, Taper>& p, const Weighted<T>& sum) {
    return SteerFinish(p, sum);
  }
};

struct SteerAlignment {
  template <typename T, typename Taper = T>
  using Params = SteerParams<T, Taper>;

  template <typename T, typename Taper>
  static Share<T> Pair(const SteerParams<T, Taper>& p, const Vec3<T>& dx, const Vec3<T>& dh) {
    return {dh, SteerWeight(p, dx)};
  }
  template <typename T, typename Taper>
  static Vec3<T> Finish(const SteerParams<T, Taper>& p, const Weighted<T>& sum) {
    return SteerFinish(p, sum);
  }
};

struct SteerCohesion {
  template <typename T, typename Taper = T>
  using Params = SteerParams<T, Taper>;

  template <typename T, typename Taper>
  static Share<T> Pair(const SteerParams<T, Taper>& p, const Vec3<T>& dx, const Vec3<T>& /*dh*/) {
    return {dx, SteerWeight(p, dx)};
  }
  template <typename T, typename Taper>
  static Vec3<T> Finish(const SteerParams<T, Taper>& p, const Weighted<T>& sum) {
    return SteerFinish(p, sum);
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FORCES_OPENSTEER_H_
