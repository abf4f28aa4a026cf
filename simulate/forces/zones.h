// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The three-zone force of BSwarm (Wang et al. 2015) as Chen et al. 2019 restate it (equations.md,
// section 3): repulsion, alignment and attraction in shells about the animal, each the mean over
// the neighbours in its shell:
//   a_i = sum_zones gain_zone mean_{j in zone}( S dx/|dx| + (1 - S^2) dv/|dv| )
//   S = 1 - W(r_rep) - W(r_ali),   W(R) = TaperWindow(|dx|; R, taper)
// With hard edges S is -1 nearer than r_rep, 0 up to r_ali, +1 up to r_att. Membership of the
// zones:
//   W(r_rep),   W(r_ali) - W(r_rep),   W(r_att) - W(r_ali)

#ifndef FLOCKLIFT_SIMULATE_FORCES_ZONES_H_
#define FLOCKLIFT_SIMULATE_FORCES_ZONES_H_

#include "simulate/forces/term.h"
#include "simulate/forces/window.h"

namespace flocklift {

template <typename T, typename Taper = T>
struct ZoneParams {
  T gain;                 // omega of the zone [m/s^2]
  T r_rep, r_ali, r_att;  // outer radii, ascending [m]
  Taper taper;            // width of their edges [m], or HardEdge
};

// What a neighbour says, whichever the zone. With hard edges either S or 1 - S^2 is 0, so that one
// of the two directions is enough.
template <typename T>
Vec3<T> ZoneDirection(const ZoneParams<T, HardEdge>& p, const Vec3<T>& dx, const Vec3<T>& dv) {
  const T squared = Dot(dx, dx);
  const auto repelled = squared < p.r_rep * p.r_rep;
  const auto aligned = (squared < p.r_ali * p.r_ali) ^ repelled;  // packs mistake != of masks
  const Vec3<T> way{select(aligned, dv.x, dx.x), select(aligned, dv.y, dx.y),
                    select(aligned, dv.z, dx.z)};
  const T scale = InverseLength(Dot(way, way));
  return select(repelled, T(-scale), scale) * way;
}
template <typename T>
Vec3<T> ZoneDirection(const ZoneParams<T>& p, const Vec3<T>& dx, const Vec3<T>& dv) {
  const T one(1.0), squared = Dot(dx, dx);
  const T s = one - TaperWindow(squared, p.r_rep, p.taper) - TaperWindow(squared, p.r_ali, p.taper);
  return (s * InverseLength(squared)) * dx + ((one - s * s) * InverseLength(Dot(dv, dv))) * dv;
}

enum class Zone { kRepulsion, kAlignment, kAttraction };

template <Zone kZone>
struct ZoneForce {
  template <typename T, typename Taper = T>
  using Params = ZoneParams<T, Taper>;

  template <typename T, typename Taper>
  static Share<T> Pair(const ZoneParams<T, Taper>& p, const Vec3<T>& dx, const Vec3<T>& dv) {
    return {ZoneDirection(p, dx, dv), Membership(p, Dot(dx, dx))};
  }

  template <typename T, typename Taper>
  static Vec3<T> Finish(const ZoneParams<T, Taper>& p, const Weighted<T>& sum) {
    return p.gain * Mean(sum);
  }

 private:
  template <typename T>
  static T Membership(const ZoneParams<T, HardEdge>& p, const T& squared) {
    const auto within = [&](const T& radius) { return squared < radius * radius; };
    if constexpr (kZone == Zone::kRepulsion) {
      return Where(within(p.r_rep), T(1.0));
    } else if constexpr (kZone == Zone::kAlignment) {
      return Where(within(p.r_ali) ^ within(p.r_rep), T(1.0));
    } else {
      return Where((squared <= p.r_att * p.r_att) ^ within(p.r_ali), T(1.0));
    }
  }
  template <typename T, typename Taper>
  static T Membership(const ZoneParams<T, Taper>& p, const T& squared) {
    if constexpr (kZone == Zone::kRepulsion) {
      return TaperWindow(squared, p.r_rep, p.taper);
    } else if constexpr (kZone == Zone::kAlignment) {
      return TaperWindow(squared, p.r_ali, p.taper) - TaperWindow(squared, p.r_rep, p.taper);
    } else {
      return ClosedTaperWindow(squared, p.r_att, p.taper) - TaperWindow(squared, p.r_ali, p.taper);
    }
  }
};

using RepulsionZone = ZoneForce<Zone::kRepulsion>;
using AlignmentZone = ZoneForce<Zone::kAlignment>;
using AttractionZone = ZoneForce<Zone::kAttraction>;

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FORCES_ZONES_H_
