// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The acceleration that one term of a scene gives to one animal, for any scalar of the animal's own
// state: a visitor of simulate/flock/force_types.h. The other animals' states are given numbers.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_TERM_AT_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_TERM_AT_H_

#include <cstdint>
#include <span>

#include "reconstruct/fit/scene_terms.h"
#include "simulate/forces/alignment.h"
#include "simulate/forces/attraction.h"
#include "simulate/forces/boundary.h"
#include "simulate/forces/cohesion.h"
#include "simulate/forces/drag.h"
#include "simulate/forces/level.h"
#include "simulate/forces/lin.h"
#include "simulate/forces/separation.h"
#include "simulate/forces/speed.h"

namespace flocklift::internal {

template <typename T>
struct TermAt {
  const TermSurroundings& around;
  std::span<const Vec3d> x, v;          // of all [m], [m/s]
  std::span<const std::uint32_t> near;  // the others that may be felt
  Vec3<T> own_x, own_v;
  double cruising_speed = 0;  // [m/s]

  static Vec3<T> AsVector(const Vec3d& a) { return {T(a.x), T(a.y), T(a.z)}; }

  template <typename Term>
  Vec3<T> Pairs(const typename Term::template Params<T>& p, double reach) const {
    Weighted<T> sum;
    for (const std::uint32_t j : near) {
      const Vec3<T> dx = AsVector(x[j]) - own_x;
      if (!(Dot(dx, dx) <= T(reach * reach))) continue;
      sum += Term::Pair(p, dx, AsVector(v[j]) - own_v);
    }
    return Term::Finish(p, sum);
  }
  static double Reach(const NeighbourForce& p) { return p.radius + 0.5 * p.taper; }

  Vec3<T> operator()(const SeparationForce& p) const {
    return Pairs<Separation>({T(p.gain), T(p.radius), T(p.taper)}, Reach(p));
  }
  Vec3<T> operator()(const CohesionForce& p) const {
    return Pairs<Cohesion>({T(p.gain), T(p.radius), T(p.taper)}, Reach(p));
  }
  Vec3<T> operator()(const AlignmentForce& p) const {
    return Pairs<Alignment>({T(p.gain), T(p.radius), T(p.taper)}, Reach(p));
  }
  Vec3<T> operator()(const RepulsionForce& p) const {
    return T(p.gain) * Pairs<LinSeparation>({T(p.radius), T(p.exponent), T(p.taper)}, Reach(p));
  }
  Vec3<T> operator()(const GoalForce& p) const {
    Vec3<T> sum{T(0.0), T(0.0), T(0.0)};
    for (const GoalSpec& goal : around.goals) {
      const Attraction::Params<T> pull{T(goal.weight), AsVector(goal.position), T(p.range)};
      sum += Attraction::At(pull, own_x, own_v);
    }
    return sum;
  }
  Vec3<T> operator()(const WallForce& p) const {
    if (!around.walls) return Nothing();
    const Boundary::Params<T> walls{T(p.gain), AsVector(around.walls->low),
                                    AsVector(around.walls->high), T(p.taper)};
    return Boundary::At(walls, own_x, own_v);
  }
  Vec3<T> operator()(const CruiseForce& p) const {
    return CruiseSpeed::At(CruiseSpeed::Params<T>{T(p.rate), T(cruising_speed)}, own_x, own_v);
  }
  Vec3<T> operator()(const LevelForce& p) const {
    return Level::At(Level::Params<T>{T(p.rate)}, own_x, own_v);
  }
  Vec3<T> operator()(const WindForce& p) const {
    return Drag::At(Drag::Params<T>{T(p.rate), AsVector(around.wind)}, own_x, own_v);
  }
  Vec3<T> operator()(const DragForce& p) const {
    return Drag::At(Drag::Params<T>{T(p.rate), AsVector({})}, own_x, own_v);
  }
  Vec3<T> operator()(const GravityForce& p) const { return {T(0.0), T(0.0), T(-p.g)}; }
  // Unknown, or what is left over.
  Vec3<T> operator()(const FleeForce&) const { return Nothing(); }
  Vec3<T> operator()(const NoiseForce&) const { return Nothing(); }
  Vec3<T> operator()(const FieldNoiseForce&) const { return Nothing(); }

  static Vec3<T> Nothing() { return {T(0.0), T(0.0), T(0.0)}; }
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_TERM_AT_H_
