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
inline double Reach(const ShapePairNumbers& n) { return std::max({n.r_rep, n.r_att, n.reach}); }

// A pair is evaluated once for all four terms: with hard edges what a term says either counts or
// does not, and the zones share one direction. Sums are those of the terms by themselves.
template <typename T>
struct ShapePairs {
  // Kernels sum animal by animal (shape_kernel_inl.h).
  static constexpr bool ByAnimal(bool /*sampled*/) { return true; }

  ZoneParams<T, HardEdge> repulsion, alignment, attraction;
  ShapeForce::Params<T, HardEdge> spread;
  T zone_reach;  // of the widest zone [m]

  using Mask = std::remove_cvref_t<decltype(std::declval<T>() < std::declval<T>())>;
  // Which terms count, and what they say: zeros where they do not.
  struct Shares {
    Mask repels, aligns, attracts, spreads;
    Vec3<T> repulsion, alignment, attraction, spread;
  };
  struct Sums {
    Weighted<T> repulsion, alignment, attraction, spread;

    Sums& operator+=(const Shares& s) {
      Take(s.repulsion, s.repels, &repulsion);
      Take(s.alignment, s.aligns, &alignment);
      Take(s.attraction, s.attracts, &attraction);
      Take(s.spread, s.spreads, &spread);
      return *this;
    }
    Sums& operator+=(const Sums& b) {
      repulsion += b.repulsion;
      alignment += b.alignment;
      attraction += b.attraction;
      spread += b.spread;
      return *this;
    }
    T Neighbours() const { return repulsion.weight + alignment.weight + attraction.weight; }

   private:
    static void Take(const Vec3<T>& value, const Mask& counts, Weighted<T>* sum) {
      sum->value += value;
      sum->weight += Where(counts, T(1.0));
    }
  };

  // Whether any term counts. By Manhattan distance the spreading reaches less far than by Euclid's.
  Mask Felt(const Vec3<T>& dx) const {
    using std::abs;
    const T manhattan = abs(dx.x) + abs(dx.y) + abs(dx.z);
    return (Dot(dx, dx) <= zone_reach * zone_reach) | (manhattan < spread.reach);
  }

  const ShapePairs& For(const Vec3<T>& /*v*/) const { return *this; }
  Shares Pair(const Vec3<T>& dx, const Vec3<T>& dv) const {
    const T squared = Dot(dx, dx);
    const Mask repels = squared < repulsion.r_rep * repulsion.r_rep;
    const Mask within = squared < repulsion.r_ali * repulsion.r_ali;
    const Mask felt = squared <= repulsion.r_att * repulsion.r_att;
    const Mask aligns(within ^ repels), attracts(felt ^ within);
    const Vec3<T> direction = ZoneDirection(repulsion, dx, dv);
    const Share<T> push = ShapeForce::Pair(spread, dx, dv);
    const Mask spreads = push.weight > T(0.0);
    return {repels,
            aligns,
            attracts,
            spreads,
            Kept(repels, direction),
            Kept(aligns, direction),
            Kept(attracts, direction),
            Kept(spreads, push.value)};
  }
  Vec3<T> Finish(const Sums& sums) const {
    return repulsion.gain * Mean(sums.repulsion) + alignment.gain * Mean(sums.alignment) +
           attraction.gain * Mean(sums.attraction) + ShapeForce::Finish(spread, sums.spread);
  }

 private:
  static Vec3<T> Kept(const Mask& mask, const Vec3<T>& v) {
    return {Where(mask, v.x), Where(mask, v.y), Where(mask, v.z)};
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
          {T(n.w_con), T(n.reach), T(n.sigma), HardEdge{}},
          T(std::max({n.r_rep, n.r_ali, n.r_att}))};
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_SHAPE_PAIRS_H_
