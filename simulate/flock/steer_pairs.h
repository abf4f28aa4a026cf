// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// OpenSteer's three rules (simulate/forces/opensteer.h) evaluated together, for kernels and loops.
// What they take for velocities are headings, velocities of length 1.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_STEER_PAIRS_H_
#define FLOCKLIFT_SIMULATE_FLOCK_STEER_PAIRS_H_

#include "simulate/forces/opensteer.h"

namespace flocklift {

// One rule; distances in metres, or whatever the scene's unit is.
struct SteerRule {
  double weight;  // [m/s^2]
  double radius;  // [m]
  double cosine;  // of the half angle that it sees
};

// Defaults of OpenSteer's boids demonstration.
struct SteerParameters {
  SteerRule separation{12, 5, -0.707};
  SteerRule alignment{8, 7.5, 0.7};
  SteerRule cohesion{8, 9, -0.15};
  double near = 1.5;                 // felt without being seen: three radii of a body of 0.5 [m]
  double taper = 0, view_taper = 0;  // widths of the edges [m], [cosine]
};

template <typename T, typename Taper = T>
struct SteerPairs {
  SteerParams<T, Taper> separation, alignment, cohesion;

  struct Shares {
    Share<T> separation, alignment, cohesion;
  };
  struct Sums {
    Weighted<T> separation, alignment, cohesion;

    // Calls add(&sum, share) for each rule.
    template <typename Add>
    void Each(const Shares& shares, const Add& add) {
      add(&separation, shares.separation);
      add(&alignment, shares.alignment);
      add(&cohesion, shares.cohesion);
    }
    Sums& operator+=(const Shares& shares) {
      separation += shares.separation;
      alignment += shares.alignment;
      cohesion += shares.cohesion;
      return *this;
    }
    T Neighbours() const { return cohesion.weight; }
  };

  // The rules of an animal with this heading.
  SteerPairs For(const Vec3<T>& heading) const {
    SteerPairs own = *this;
    own.separation.view.heading = own.alignment.view.heading = own.cohesion.view.heading = heading;
    return own;
  }
  Shares Pair(const Vec3<T>& dx, const Vec3<T>& dh) const {
    return {SteerSeparation::Pair(separation, dx, dh), SteerAlignment::Pair(alignment, dx, dh),
            SteerCohesion::Pair(cohesion, dx, dh)};
  }
  Vec3<T> Finish(const Sums& sums) const {
    return SteerSeparation::Finish(separation, sums.separation) +
           SteerAlignment::Finish(alignment, sums.alignment) +
           SteerCohesion::Finish(cohesion, sums.cohesion);
  }
};

template <typename T, typename Taper = T>
SteerPairs<T, Taper> MakeSteerPairs(const SteerParameters& p, Taper taper, Taper view_taper) {
  const auto rule = [&](const SteerRule& r) -> SteerParams<T, Taper> {
    return {T(r.weight), T(r.radius), T(p.near), taper, {{}, T(r.cosine), view_taper}};
  };
  return {rule(p.separation), rule(p.alignment), rule(p.cohesion)};
}

// How far a neighbour can be felt [m].
inline double Reach(const SteerParameters& p) {
  double most = p.near;
  for (const SteerRule& rule : {p.separation, p.alignment, p.cohesion}) {
    if (rule.radius > most) most = rule.radius;
  }
  return most + 0.5 * p.taper;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_STEER_PAIRS_H_
