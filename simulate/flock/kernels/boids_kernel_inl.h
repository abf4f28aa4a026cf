// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The body of every variant of the boids kernel; included once by each, after it has defined
//   std::uint64_t LaneMask(batch_bool)                              bit k: lane k
//   std::uint32_t AppendSetBits(mask, base, list)                   list base + k; how many
// Everything lives in an anonymous namespace (boids_kernel.h says why).

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_BOIDS_KERNEL_INL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_BOIDS_KERNEL_INL_H_

#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "simulate/flock/boids.h"
#include "simulate/flock/integrator.h"
#include "simulate/flock/kernels/boids_kernel.h"

namespace flocklift {
namespace {

struct Interval {
  float low, high;
};

Interval Bounds(const float* values, std::uint32_t first, std::uint32_t last) {
  Interval bounds{values[first], values[first]};
  for (std::uint32_t k = first + 1; k < last; ++k) {
    bounds.low = values[k] < bounds.low ? values[k] : bounds.low;
    bounds.high = values[k] > bounds.high ? values[k] : bounds.high;
  }
  return bounds;
}

// Distance of each lane to an interval, 0 inside.
template <typename Pack>
Pack Outside(const Pack& value, const Interval& interval) {
  const Pack below = Pack(interval.low) - value, above = value - Pack(interval.high);
  return xsimd::max(Pack(0.0f), xsimd::max(below, above));
}

// The candidates of one tile.
struct Candidates {
  std::uint32_t* list;
  std::uint32_t count;
};

// Appends those of [first, last) that are within sqrt(squared_reach) of the box.
template <typename Pack>
void AppendNear(const BoidsJob& job, std::uint32_t first, std::uint32_t last, const Interval* box,
                float squared_reach, Candidates* candidates) {
  constexpr std::uint32_t kLanes = Pack::size;
  for (std::uint32_t j = first; j < last; j += kLanes) {
    const Pack x = Outside(Pack::load_unaligned(job.x + j), box[0]);
    const Pack y = Outside(Pack::load_unaligned(job.y + j), box[1]);
    const Pack z = Outside(Pack::load_unaligned(job.z + j), box[2]);
    std::uint64_t mask = LaneMask(x * x + y * y + z * z < Pack(squared_reach));
    if (last - j < kLanes) mask &= (std::uint64_t{1} << (last - j)) - 1;
    std::uint32_t* const list = candidates->list + candidates->count;
    candidates->count += AppendSetBits(mask, j, list);
  }
}

// The nine runs of cells around a tile; the tile's own animals, all of them, start at *self.
template <typename Pack>
void CollectCandidates(const BoidsJob& job, std::uint32_t first, std::uint32_t last, int row,
                       Candidates* candidates, std::uint32_t* self) {
  const Interval box[3] = {Bounds(job.x, first, last), Bounds(job.y, first, last),
                           Bounds(job.z, first, last)};
  const auto cell_x = [&job](float x) {
    const int a = static_cast<int>((x - job.low_x) * job.inverse_edge);
    return 1 + (a < job.nx ? a : job.nx - 1);
  };
  const int a0 = cell_x(box[0].low), a1 = cell_x(box[0].high);
  const float squared_reach = job.reach * job.reach;
  candidates->count = 0;
  for (int dc = 0; dc <= 2; ++dc) {
    for (int db = 0; db <= 2; ++db) {
      const int line = ((row / job.ny + dc) * (job.ny + 2) + row % job.ny + db) * (job.nx + 2);
      const std::uint32_t run_first = job.start[line + a0 - 1];
      const std::uint32_t run_last = job.start[line + a1 + 2];
      if (dc == 1 && db == 1) {
        AppendNear<Pack>(job, run_first, first, box, squared_reach, candidates);
        *self = candidates->count;
        for (std::uint32_t k = first; k < last; ++k) candidates->list[candidates->count++] = k;
        AppendNear<Pack>(job, last, run_last, box, squared_reach, candidates);
      } else {
        AppendNear<Pack>(job, run_first, run_last, box, squared_reach, candidates);
      }
    }
  }
}

template <typename Pack>
void Store(const Pack& pack, std::uint32_t first, std::uint32_t last, float* to) {
  alignas(64) float lanes[Pack::size];
  pack.store_aligned(lanes);
  for (std::uint32_t k = first; k < last; ++k) to[k] = lanes[k - first];
}

// The sum over neighbours with one more. Weights of hard windows are 0 or 1, the product is exact,
// and a fused operation rounds as the two do.
template <typename Pack>
[[gnu::always_inline]] inline void Add(const Share<Pack>& share, HardEdge /*taper*/,
                                       Weighted<Pack>* sum) {
  sum->value.x = xsimd::fma(share.weight, share.value.x, sum->value.x);
  sum->value.y = xsimd::fma(share.weight, share.value.y, sum->value.y);
  sum->value.z = xsimd::fma(share.weight, share.value.z, sum->value.z);
  sum->weight += share.weight;
}
template <typename Pack>
[[gnu::always_inline]] inline void Add(const Share<Pack>& share, const Pack& /*taper*/,
                                       Weighted<Pack>* sum) {
  *sum += share;
}
template <typename Pairs, typename Taper>
[[gnu::always_inline]] inline void AddAll(const typename Pairs::Shares& shares, const Taper& taper,
                                          typename Pairs::Sums* sums) {
  Add(shares.separation, taper, &sums->separation);
  Add(shares.cohesion, taper, &sums->cohesion);
  Add(shares.alignment, taper, &sums->alignment);
}

template <typename Pack, typename Taper>
void Tile(const BoidsJob& job, const BoidsPairs<Pack, Taper>& pairs, std::uint32_t first,
          std::uint32_t last, const Candidates& candidates, std::uint32_t self) {
  using Pairs = BoidsPairs<Pack, Taper>;
  const Taper taper = pairs.separation.taper;
  const Vec3<Pack> x{Pack::load_unaligned(job.x + first), Pack::load_unaligned(job.y + first),
                     Pack::load_unaligned(job.z + first)};
  const Vec3<Pack> v{Pack::load_unaligned(job.vx + first), Pack::load_unaligned(job.vy + first),
                     Pack::load_unaligned(job.vz + first)};
  const auto pair = [&](std::uint32_t j) {
    const Vec3<Pack> dx = Vec3<Pack>{Pack(job.x[j]), Pack(job.y[j]), Pack(job.z[j])} - x;
    const Vec3<Pack> dv = Vec3<Pack>{Pack(job.vx[j]), Pack(job.vy[j]), Pack(job.vz[j])} - v;
    return pairs.Pair(dx, dv);
  };
  typename Pairs::Sums sums;
  for (std::uint32_t q = 0; q < self; ++q) {
    AddAll<Pairs>(pair(candidates.list[q]), taper, &sums);
  }
  alignas(64) float lane_numbers[Pack::size];
  for (std::uint32_t k = 0; k < Pack::size; ++k) lane_numbers[k] = static_cast<float>(k);
  const Pack lane = Pack::load_aligned(lane_numbers), zero(0.0f);
  for (std::uint32_t q = 0; q < last - first; ++q) {  // everybody but oneself
    const auto other = lane != Pack(static_cast<float>(q));
    typename Pairs::Shares shares = pair(first + q);
    shares.separation.weight = xsimd::select(other, shares.separation.weight, zero);
    shares.cohesion.weight = xsimd::select(other, shares.cohesion.weight, zero);
    shares.alignment.weight = xsimd::select(other, shares.alignment.weight, zero);
    AddAll<Pairs>(shares, taper, &sums);
  }
  for (std::uint32_t q = self + (last - first); q < candidates.count; ++q) {
    AddAll<Pairs>(pair(candidates.list[q]), taper, &sums);
  }
  const Vec3<Pack> acceleration = pairs.Finish(sums);
  Store(acceleration.x, first, last, job.ax);
  Store(acceleration.y, first, last, job.ay);
  Store(acceleration.z, first, last, job.az);
  Store(sums.cohesion.weight, first, last, job.neighbours);
}

template <typename Pack, typename Taper>
void Rows(const BoidsJob& job, Taper taper, int first_row, int last_row,
          std::uint32_t* candidate_room) {
  const BoidsPairs<Pack, Taper> pairs{{Pack(job.alpha_s), Pack(job.d_s), taper},
                                      {Pack(job.alpha_c), Pack(job.d_v), taper},
                                      {Pack(job.alpha_a), Pack(job.d_v), taper}};
  Candidates candidates{candidate_room, 0};
  for (int row = first_row; row < last_row; ++row) {
    const int line = ((row / job.ny + 1) * (job.ny + 2) + row % job.ny + 1) * (job.nx + 2);
    const std::uint32_t row_last = job.start[line + job.nx + 1];
    for (std::uint32_t first = job.start[line + 1]; first < row_last; first += Pack::size) {
      const std::uint32_t last =
          row_last - first < Pack::size ? row_last : first + static_cast<std::uint32_t>(Pack::size);
      std::uint32_t self = 0;
      CollectCandidates<Pack>(job, first, last, row, &candidates, &self);
      Tile(job, pairs, first, last, candidates, self);
    }
  }
}

template <typename Pack>
void BoidsRows(const BoidsJob& job, int first_row, int last_row, std::uint32_t* candidates) {
  if (job.taper > 0) {
    Rows<Pack>(job, Pack(job.taper), first_row, last_row, candidates);
  } else {
    Rows<Pack>(job, HardEdge{}, first_row, last_row, candidates);
  }
}

template <typename Pack>
void Move(const MoveJob& job, std::uint32_t first, std::uint32_t last) {
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

}  // namespace
}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_BOIDS_KERNEL_INL_H_
