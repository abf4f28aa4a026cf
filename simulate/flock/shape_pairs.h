// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What neighbours do in a shape-constrained swarm: the three zones of BSwarm (simulate/forces/
// zones.h) and the shape force (simulate/forces/shape_force.h), evaluated together.
//   a_i = alpha F_int + (1 - alpha) F_con

#ifndef FLOCKLIFT_SIMULATE_FLOCK_SHAPE_PAIRS_H_
#define FLOCKLIFT_SIMULATE_FLOCK_SHAPE_PAIRS_H_

#include <algorithm>

#include "simulate/flock/shape_model.h"
#include "simulate/flock/zone_pairs.h"
#include "simulate/forces/shape_force.h"

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
inline double Reach(const ShapePairNumbers& n) { return std::max({n.r_rep, n.r_att, n.reach}); }

template <typename T>
struct ShapePairs {
  // On a surface few of a tile's candidates are neighbours: kernels sum animal by animal.
  static constexpr bool kByAnimal = true;
  static constexpr int kTerms = 4;  // sums

  ZonePairs<T, HardEdge> zones;
  ShapeForce::Params<T, HardEdge> spread;

  struct Shares {
    typename ZonePairs<T, HardEdge>::Shares zones;
    Share<T> spread;
  };
  struct Sums {
    typename ZonePairs<T, HardEdge>::Sums zones;
    Weighted<T> spread;

    // Calls add(&sum, share) for each term.
    template <typename Add>
    void Each(const Shares& shares, const Add& add) {
      zones.Each(shares.zones, add);
      add(&spread, shares.spread);
    }
    Sums& operator+=(const Shares& shares) {
      zones += shares.zones;
      spread += shares.spread;
      return *this;
    }
    Sums& operator+=(const Sums& b) {
      zones += b.zones;
      spread += b.spread;
      return *this;
    }
    T Neighbours() const { return zones.Neighbours(); }
    // Calls fn(&sum) for each term, in the order of Each.
    template <typename Function>
    void All(const Function& fn) {
      zones.All(fn);
      fn(&spread);
    }
  };

  const ShapePairs& For(const Vec3<T>& /*v*/) const { return *this; }
  Shares Pair(const Vec3<T>& dx, const Vec3<T>& dv) const {
    return {zones.Pair(dx, dv), ShapeForce::Pair(spread, dx, dv)};
  }
  Vec3<T> Finish(const Sums& sums) const {
    return zones.Finish(sums.zones) + ShapeForce::Finish(spread, sums.spread);
  }
};

template <typename T>
ShapePairs<T> MakeShapePairs(const ShapePairNumbers& n) {
  const auto zone = [&n](double gain) -> ZoneParams<T, HardEdge> {
    return {T(gain), T(n.r_rep), T(n.r_ali), T(n.r_att), HardEdge{}};
  };
  return {{zone(n.w_rep), zone(n.w_ali), zone(n.w_att)},
          {T(n.w_con), T(n.reach), T(n.sigma), HardEdge{}}};
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_SHAPE_PAIRS_H_
