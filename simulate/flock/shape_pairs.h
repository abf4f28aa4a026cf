// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What neighbours do in a shape-constrained swarm: the three zones of BSwarm (simulate/forces/
// zones.h) and the shape force (simulate/forces/shape_force.h), evaluated together.
//   a_i = alpha F_int + (1 - alpha) F_con

#ifndef FLOCKLIFT_SIMULATE_FLOCK_SHAPE_PAIRS_H_
#define FLOCKLIFT_SIMULATE_FLOCK_SHAPE_PAIRS_H_

#include <algorithm>
#include <cmath>

#include "simulate/flock/shape_model.h"
#include "simulate/forces/shape_force.h"
#include "simulate/forces/term.h"
#include "simulate/forces/zones.h"

namespace flocklift {

// The numbers of the pairs at one step. Gains hold alpha and 1 - alpha.
struct ShapePairNumbers {
  double r_rep, r_ali, r_att, w_rep, w_ali, w_att;  // of the zones, cut at the range
  double w_con, reach, sigma;                       // of the shape force
};

// `spacing` is the mean distance of samples sqrt(A/N) [m]; the zones end at `range` [m].
inline ShapePairNumbers MakeShapePairNumbers(const ShapeParameters& p, double spacing,
                                             double range) {
  return {.r_rep = std::min(p.r_rep, range),
          .r_ali = std::min(p.r_ali, range),
          .r_att = std::min(p.r_att, range),
          .w_rep = p.alpha * p.w_rep,
          .w_ali = p.alpha * p.w_ali,
          .w_att = p.alpha * p.w_att,
          .w_con = (1 - p.alpha) * p.w_con,
          .reach = p.k * spacing,
          .sigma = p.omega * spacing};
}

// How far a neighbour can be felt [m]: the Manhattan distance is never less than the Euclidean.
inline double Reach(const ShapePairNumbers& n) {
  return std::max({n.r_rep, n.r_ali, n.r_att, n.reach});
}

// The four terms together: what they share of a pair is worked out once. Sums are those of the
// terms by themselves but for round-off.
template <typename T>
struct ShapePairs {
  ZoneParams<T, HardEdge> repulsion, alignment, attraction;
  ShapeForce::Params<T, HardEdge> spread;

  struct Sums {
    Weighted<T> repel, align, attract, spread;
    T Neighbours() const { return repel.weight + align.weight + attract.weight; }
  };

  const ShapePairs& For(const Vec3<T>& /*v*/) const { return *this; }
  void Add(const Vec3<T>& dx, const Vec3<T>& dv, Sums* sums) const {
    using std::abs;
    const T squared = Dot(dx, dx), manhattan = abs(dx.x) + abs(dx.y) + abs(dx.z);
    const auto repels = squared < repulsion.r_rep * repulsion.r_rep;
    const auto within = squared < repulsion.r_ali * repulsion.r_ali;
    const auto felt = squared <= repulsion.r_att * repulsion.r_att;
    const Vec3<T> direction = InverseLength(squared) * dx;
    Count(repels, direction, &sums->repel);
    Count(felt ^ within, direction, &sums->attract);
    Count(within ^ repels, InverseLength(Dot(dv, dv)) * dv, &sums->align);
    const T share = manhattan * (T(1.0) / spread.sigma);
    Count(manhattan < spread.reach, ShapeForce::Fall(T(T(0.5) * share * share)) * direction,
          &sums->spread);
  }

  Vec3<T> Finish(const Sums& sums) const {
    return attraction.gain * Mean(sums.attract) - repulsion.gain * Mean(sums.repel) +
           alignment.gain * Mean(sums.align) - spread.gain * Mean(sums.spread);
  }

 private:
  template <typename Mask>
  static void Count(const Mask& mask, const Vec3<T>& value, Weighted<T>* sum) {
    sum->value += {Where(mask, value.x), Where(mask, value.y), Where(mask, value.z)};
    sum->weight += Where(mask, T(1.0));
  }
};

template <typename T>
ShapePairs<T> MakeShapePairs(const ShapePairNumbers& n) {
  const auto zone = [&n](double gain) -> ZoneParams<T, HardEdge> {
    return {T(gain), T(n.r_rep), T(n.r_ali), T(n.r_att), HardEdge{}};
  };
  return {zone(n.w_rep),
          zone(n.w_ali),
          zone(n.w_att),
          {T(n.w_con), T(n.reach), T(n.sigma), HardEdge{}}};
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_SHAPE_PAIRS_H_
