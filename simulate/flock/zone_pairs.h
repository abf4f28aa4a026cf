// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The three zones of BSwarm (simulate/forces/zones.h) evaluated together, for kernels and loops.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_ZONE_PAIRS_H_
#define FLOCKLIFT_SIMULATE_FLOCK_ZONE_PAIRS_H_

#include <type_traits>

#include "simulate/forces/zones.h"

namespace flocklift {

// Defaults of Chen et al. 2019, table 1. The radii are scene units.
struct ZoneParameters {
  double r_rep = 0.3, r_ali = 10, r_att = 30;  // [m]
  double w_rep = 0.2, w_ali = 3, w_att = 13;   // [m/s^2]
  double taper = 0;                            // [m]
};

template <typename T, typename Taper = T>
struct ZonePairs {
  // Whether kernels sum animal by animal (zones_kernel_inl.h), those who attract apart. It pays
  // where most candidates are no neighbours: not in a sample, taken from where nearly all are.
  static constexpr bool ByAnimal(bool sampled) {
    return std::is_same_v<Taper, HardEdge> && !sampled;
  }

  ZoneParams<T, Taper> repulsion, alignment, attraction;

  struct Shares {
    Share<T> repulsion, alignment, attraction;
  };
  struct Sums {
    Weighted<T> repulsion, alignment, attraction;

    // Calls add(&sum, share) for each zone.
    template <typename Add>
    void Each(const Shares& shares, const Add& add) {
      add(&repulsion, shares.repulsion);
      add(&alignment, shares.alignment);
      add(&attraction, shares.attraction);
    }
    Sums& operator+=(const Shares& shares) {
      repulsion += shares.repulsion;
      alignment += shares.alignment;
      attraction += shares.attraction;
      return *this;
    }
    Sums& operator+=(const Sums& b) {
      repulsion += b.repulsion;
      alignment += b.alignment;
      attraction += b.attraction;
      return *this;
    }
    T Neighbours() const { return repulsion.weight + alignment.weight + attraction.weight; }
    // Calls fn(&sum) for each zone, in the order of Each.
    template <typename Function>
    void All(const Function& fn) {
      fn(&repulsion);
      fn(&alignment);
      fn(&attraction);
    }
  };

  // Whether any zone counts, and whether it can only be that of attraction.
  auto Felt(const Vec3<T>& dx) const { return Dot(dx, dx) <= attraction.r_att * attraction.r_att; }
  auto Apart(const Vec3<T>& dx) const { return Dot(dx, dx) >= alignment.r_ali * alignment.r_ali; }

  const ZonePairs& For(const Vec3<T>& /*v*/) const { return *this; }
  Shares Pair(const Vec3<T>& dx, const Vec3<T>& dv) const {
    return {RepulsionZone::Pair(repulsion, dx, dv), AlignmentZone::Pair(alignment, dx, dv),
            AttractionZone::Pair(attraction, dx, dv)};
  }
  Vec3<T> Finish(const Sums& sums) const {
    return RepulsionZone::Finish(repulsion, sums.repulsion) +
           AlignmentZone::Finish(alignment, sums.alignment) +
           AttractionZone::Finish(attraction, sums.attraction);
  }
};

template <typename T, typename Taper = T>
ZonePairs<T, Taper> MakeZonePairs(const ZoneParameters& p, Taper taper) {
  const auto zone = [&](double gain) -> ZoneParams<T, Taper> {
    return {T(gain), T(p.r_rep), T(p.r_ali), T(p.r_att), taper};
  };
  return {zone(p.w_rep), zone(p.w_ali), zone(p.w_att)};
}

// How far a neighbour can be felt [m].
inline double Reach(const ZoneParameters& p) { return p.r_att + 0.5 * p.taper; }

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_ZONE_PAIRS_H_
