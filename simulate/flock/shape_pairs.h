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
#include <type_traits>
#include <utility>

#include "simulate/flock/shape_model.h"
#include "simulate/forces/shape_force.h"
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

// The four terms together. Each is a mean over those that it counts; so neighbours are counted
// first, and then every pair is one sum of its directions, each with its term's gain over its
// count. Sums are those of the terms by themselves but for round-off.
template <typename T>
struct ShapePairs {
  ZoneParams<T, HardEdge> repulsion, alignment, attraction;
  ShapeForce::Params<T, HardEdge> spread;

  using Mask = std::remove_cvref_t<decltype(std::declval<T>() < std::declval<T>())>;
  // Which terms count a neighbour.
  struct Terms {
    Mask repels, aligns, attracts, spreads;
  };
  // By term: how many neighbours count, and the gain over that.
  struct ByTerm {
    T repel = T(0.0), align = T(0.0), attract = T(0.0), spread = T(0.0);
  };

  // The masks of the zones alone; `spreads` is left to the caller.
  Terms ZonesOf(const T& squared, const Mask& spreads) const {
    const Mask repels = squared < repulsion.r_rep * repulsion.r_rep;
    const Mask within = squared < repulsion.r_ali * repulsion.r_ali;
    const Mask felt = squared <= repulsion.r_att * repulsion.r_att;
    return {repels, Mask(within ^ repels), Mask(felt ^ within), spreads};
  }
  // What is seen of a neighbour before the gains are known.
  struct Look {
    Vec3<T> direction;
    T squared;  // distance [m^2]
    T fall;     // of the spreading; 0 beyond its reach
    Mask spreads;
  };
  Look LookAt(const Vec3<T>& dx) const {
    using std::abs;
    const T squared = Dot(dx, dx), manhattan = abs(dx.x) + abs(dx.y) + abs(dx.z);
    const Mask spreads = manhattan < spread.reach;
    const T share = manhattan * (T(1.0) / spread.sigma);
    const T fall = Where(spreads, ShapeForce::Fall(T(T(0.5) * share * share)));
    return {InverseLength(squared) * dx, squared, fall, spreads};
  }

  void Count(const Look& look, ByTerm* counts) const {
    const Terms terms = ZonesOf(look.squared, look.spreads);
    counts->repel += Where(terms.repels, T(1.0));
    counts->align += Where(terms.aligns, T(1.0));
    counts->attract += Where(terms.attracts, T(1.0));
    counts->spread += Where(terms.spreads, T(1.0));
  }
  ByTerm Gains(const ByTerm& counts) const {
    const auto share = [](const T& gain, const T& count) -> T {
      return Where(count > T(0.0), T(gain / select(count > T(0.0), count, T(1.0))));
    };
    return {share(repulsion.gain, counts.repel), share(alignment.gain, counts.align),
            share(attraction.gain, counts.attract), share(spread.gain, counts.spread)};
  }
  static T Neighbours(const ByTerm& counts) { return counts.repel + counts.align + counts.attract; }

  // What a neighbour adds to the acceleration.
  Vec3<T> Pair(const ByTerm& gains, const Vec3<T>& direction, const T& squared, const T& fall,
               const Vec3<T>& dv) const {
    const Terms terms = ZonesOf(squared, {});
    const T zone = Where(terms.attracts, gains.attract) - Where(terms.repels, gains.repel);
    const T along = zone - gains.spread * fall;
    const T beside = Where(terms.aligns, gains.align) * InverseLength(Dot(dv, dv));
    return along * direction + beside * dv;
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
