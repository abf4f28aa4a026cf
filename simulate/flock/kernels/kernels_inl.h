// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The kernels of a variant, on a pack of its own. See pair_kernel_inl.h.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_KERNELS_INL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_KERNELS_INL_H_

#include "simulate/flock/boids.h"
#include "simulate/flock/integrator.h"
#include "simulate/flock/kernels/list_kernel_inl.h"
#include "simulate/flock/kernels/listed_kernel_inl.h"
#include "simulate/flock/kernels/pair_kernel_inl.h"
#include "simulate/flock/kernels/zones_kernel_inl.h"
#include "simulate/flock/shape_pairs.h"
#include "simulate/flock/steer_pairs.h"
#include "simulate/flock/zone_pairs.h"

namespace flocklift {
namespace {

// By the lists where there are any.
template <typename Pack, typename Rules, typename Taper>
[[gnu::always_inline]] inline void Sum(const PairJob& job, const Rules& rules, Taper taper,
                                       std::uint32_t first, std::uint32_t last,
                                       std::uint32_t* room) {
  if (job.listed.rows != nullptr) {
    SumListed<Pack>(job.listed, job.sums, rules, taper, first, last);
  } else {
    SumPairs<Pack>(job, rules, taper, first, last, room);
  }
}

template <typename Pack>
struct Kernels {
  [[gnu::flatten]] static void Boids(const BoidsJob& job, std::uint32_t first, std::uint32_t last,
                                     std::uint32_t* room) {
    const auto run = [&](auto taper, const auto& view) {
      using Taper = decltype(taper);
      using View = std::remove_cvref_t<decltype(view)>;
      const BoidsPairs<Pack, Taper, View> rules{{Pack(job.alpha_s), Pack(job.d_s), taper},
                                                {Pack(job.alpha_c), Pack(job.d_v), taper},
                                                {Pack(job.alpha_a), Pack(job.d_v), taper},
                                                view};
      Sum<Pack>(job.pairs, rules, taper, first, last, room);
    };
    const Pack cosine(job.view_cosine), taper(job.taper);
    if (job.taper > 0 || (job.cone && job.view_taper > 0)) {
      if (job.cone) {
        run(taper, ViewCone<Pack>{{}, cosine, Pack(job.view_taper)});
      } else {
        run(taper, AllRound{});
      }
    } else if (job.cone) {
      run(HardEdge{}, ViewCone<Pack, HardEdge>{{}, cosine, {}});
    } else {
      run(HardEdge{}, AllRound{});
    }
  }

  [[gnu::flatten]] static void Zones(const ZonesJob& job, std::uint32_t first, std::uint32_t last,
                                     std::uint32_t* room) {
    const auto run = [&](auto taper) {
      Sum<Pack>(job.pairs, ZoneRules<Pack>(job, taper), taper, first, last, room);
    };
    if (job.taper > 0) {
      run(Pack(job.taper));
    } else if (job.pairs.listed.rows == nullptr &&
               ZonePairs<Pack, HardEdge>::ByAnimal(job.pairs.sample != nullptr)) {
      SumZonesByAnimal<Pack>(job, first, last);
    } else {
      run(HardEdge{});
    }
  }

  [[gnu::flatten]] static std::uint32_t List(const ListJob& job, std::uint32_t first,
                                             std::uint32_t last) {
    return ListTiles<Pack>(job, first, last);
  }

  [[gnu::flatten]] static void Shape(const ShapeJob& job, std::uint32_t first, std::uint32_t last) {
    const auto zone = [&](float gain) -> ZoneParams<Pack, HardEdge> {
      return {Pack(gain), Pack(job.r_rep), Pack(job.r_ali), Pack(job.r_att), HardEdge{}};
    };
    const ShapePairs<Pack> rules{zone(job.w_rep),
                                 zone(job.w_ali),
                                 zone(job.w_att),
                                 {Pack(job.w_con), Pack(job.reach), Pack(job.sigma), HardEdge{}}};
    SumListed<Pack>(job.listed, job.sums, rules, HardEdge{}, first, last);
  }

  [[gnu::flatten]] static void Steer(const SteerJob& job, std::uint32_t first, std::uint32_t last,
                                     std::uint32_t* room) {
    const auto run = [&](auto taper, auto view_taper) {
      using Taper = decltype(taper);
      const auto rule = [&](const SteerJob::Rule& r) -> SteerParams<Pack, Taper> {
        return {Pack(r.weight),
                Pack(r.radius),
                Pack(job.near),
                taper,
                {{}, Pack(r.cosine), view_taper}};
      };
      const SteerPairs<Pack, Taper> rules{rule(job.separation), rule(job.alignment),
                                          rule(job.cohesion)};
      SumPairs<Pack>(job.pairs, rules, taper, first, last, room);
    };
    if (job.taper > 0 || job.view_taper > 0) {
      run(Pack(job.taper), Pack(job.view_taper));
    } else {
      run(HardEdge{}, HardEdge{});
    }
  }

  static void Move(const MoveJob& job, std::uint32_t first, std::uint32_t last) {
    const SpeedLimit::Params<Pack> limit{Pack(job.s_min), Pack(job.s_max), Pack(0.0f)};
    const auto load = [](const float* x, const float* y, const float* z) {
      return Vec3<Pack>{Pack::load_unaligned(x), Pack::load_unaligned(y), Pack::load_unaligned(z)};
    };
    for (std::uint32_t k = first; k < last; k += Pack::size) {
      Vec3<Pack> x = load(job.x + k, job.y + k, job.z + k);
      Vec3<Pack> v = load(job.vx + k, job.vy + k, job.vz + k);
      Advance(load(job.ax + k, job.ay + k, job.az + k), Pack(job.dt), limit, &x, &v);
      x.x.store_unaligned(job.x + k);
      x.y.store_unaligned(job.y + k);
      x.z.store_unaligned(job.z + k);
      v.x.store_unaligned(job.vx + k);
      v.y.store_unaligned(job.vy + k);
      v.z.store_unaligned(job.vz + k);
    }
  }

  static constexpr KernelVariant Named(const char* name, bool (*supported)()) {
    return {name, supported, Boids, Zones, Steer, List, Shape, Move};
  }
};

}  // namespace
}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_KERNELS_INL_H_
