// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The loop over pairs of every kernel; included once by each variant, after it has defined
//   std::uint64_t LaneMask(batch_bool)                              bit k: lane k
//   std::uint32_t AppendSetBits(mask, base, list)                   list base + k; how many
// Everything lives in an anonymous namespace (kernels.h says why). What the pairs do to each other
// is the rules' business: BoidsPairs, ZonePairs, SteerPairs.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_PAIR_KERNEL_INL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_PAIR_KERNEL_INL_H_

#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "simulate/flock/kernels/kernels.h"
#include "simulate/forces/term.h"
#include "simulate/forces/window.h"

namespace flocklift {
namespace {

// Where (simulate/core/vec3.h) of a pack: one instruction.
template <typename Arch>
[[gnu::always_inline]] inline xsimd::batch<float, Arch> Where(
    const xsimd::batch_bool<float, Arch>& mask, const xsimd::batch<float, Arch>& value) {
  return xsimd::batch<float, Arch>(mask.data) & value;
}

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

// Animals first .. last - 1 of a row of cells, no more than a pack has lanes.
struct TileOf {
  std::uint32_t first, last;
  int row;
};

int CellX(const PairJob& job, float x) {
  const int a = static_cast<int>((x - job.low_x) * job.inverse_edge);
  return 1 + (a < job.nx ? a : job.nx - 1);
}

// Where a tile that begins at `first` ends. Where a row of cells has a gap (a swarm on a surface is
// hollow) the tile ends before it: the box around it would reach over all that lies between.
std::uint32_t TileEnd(const PairJob& job, std::uint32_t first, std::uint32_t last) {
  constexpr int kWidestGap = 2;  // cells
  const int farthest = CellX(job, job.x[first]) + kWidestGap;
  while (last - 1 > first && CellX(job, job.x[last - 1]) > farthest) --last;
  return last;
}

// The candidates of a tile. Its own animals among them are list[self] .. list[self_end - 1].
struct Candidates {
  std::uint32_t* list;
  std::uint32_t count, self, self_end;
};

// Appends those of [first, last) that are within sqrt(squared_reach) of the box.
template <typename Pack>
void AppendNear(const PairJob& job, std::uint32_t first, std::uint32_t last, const Interval* box,
                float squared_reach, Candidates* candidates) {
  constexpr std::uint32_t kLanes = Pack::size;
  for (std::uint32_t j = first; j < last; j += kLanes) {
    const Pack x = Outside(Pack::load_unaligned(job.x + j), box[0]);
    const Pack y = Outside(Pack::load_unaligned(job.y + j), box[1]);
    const Pack z = Outside(Pack::load_unaligned(job.z + j), box[2]);
    std::uint64_t mask = LaneMask(x * x + y * y + z * z <= Pack(squared_reach));
    if (last - j < kLanes) mask &= (std::uint64_t{1} << (last - j)) - 1;
    candidates->count += AppendSetBits(mask, j, candidates->list + candidates->count);
  }
}

// Calls fn(j) for those of [first, last) that the row samples, wherever they are.
template <typename Function>
void ForEachSampled(const RowSample& sample, std::uint32_t first, std::uint32_t last,
                    const Function& fn) {
  const std::uint32_t past = first % sample.stride;
  const std::uint32_t way =
      sample.phase >= past ? sample.phase - past : sample.phase + sample.stride - past;
  for (std::uint32_t j = first + way; j < last; j += sample.stride) fn(j);
}

// Calls fn(first, last, own_row) for the nine runs of cells around a tile, in the order of the
// sort. `x` bounds the tile.
template <typename Function>
void ForEachRun(const PairJob& job, const TileOf& tile, const Interval& x, const Function& fn) {
  const int a0 = CellX(job, x.low), a1 = CellX(job, x.high);
  const int row_b = tile.row % job.ny, row_c = tile.row / job.ny;
  for (int dc = 0; dc <= 2; ++dc) {
    for (int db = 0; db <= 2; ++db) {
      const int line = ((row_c + dc) * (job.ny + 2) + row_b + db) * (job.nx + 2);
      fn(job.start[line + a0 - 1], job.start[line + a1 + 2], dc == 1 && db == 1);
    }
  }
}

// Everybody around a tile who is near enough or in the sample.
template <typename Pack>
[[gnu::noinline]] void CollectCandidates(const PairJob& job, const TileOf& tile,
                                         Candidates* candidates) {
  const Interval box[3] = {Bounds(job.x, tile.first, tile.last),
                           Bounds(job.y, tile.first, tile.last),
                           Bounds(job.z, tile.first, tile.last)};
  const float squared_reach = job.reach * job.reach;
  const RowSample sample = job.sample != nullptr ? job.sample[tile.row] : RowSample{1, 0};
  const auto append = [&](std::uint32_t first, std::uint32_t last) {
    if (sample.stride > 1) {
      ForEachSampled(sample, first, last,
                     [candidates](std::uint32_t j) { candidates->list[candidates->count++] = j; });
    } else {
      AppendNear<Pack>(job, first, last, box, squared_reach, candidates);
    }
  };
  candidates->count = 0;
  ForEachRun(job, tile, box[0], [&](std::uint32_t first, std::uint32_t last, bool own_row) {
    if (own_row) {
      append(first, tile.first);
      candidates->self = candidates->count;
      append(tile.first, tile.last);
      candidates->self_end = candidates->count;
      append(tile.last, last);
    } else {
      append(first, last);
    }
  });
}

template <typename Pack>
void Store(const Pack& pack, const TileOf& tile, float* to) {
  alignas(64) float lanes[Pack::size];
  pack.store_aligned(lanes);
  for (std::uint32_t k = tile.first; k < tile.last; ++k) to[k] = lanes[k - tile.first];
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

template <typename Pack, typename Rules, typename Taper>
[[gnu::always_inline]] inline void SumTile(const PairJob& job, const Rules& rules, Taper taper,
                                           const TileOf& tile, const Candidates& candidates) {
  const Vec3<Pack> x{Pack::load_unaligned(job.x + tile.first),
                     Pack::load_unaligned(job.y + tile.first),
                     Pack::load_unaligned(job.z + tile.first)};
  const Vec3<Pack> v{Pack::load_unaligned(job.vx + tile.first),
                     Pack::load_unaligned(job.vy + tile.first),
                     Pack::load_unaligned(job.vz + tile.first)};
  const auto own = rules.For(v);
  const auto pair = [&](std::uint32_t j) {
    const Vec3<Pack> dx = Vec3<Pack>{Pack(job.x[j]), Pack(job.y[j]), Pack(job.z[j])} - x;
    const Vec3<Pack> dv = Vec3<Pack>{Pack(job.vx[j]), Pack(job.vy[j]), Pack(job.vz[j])} - v;
    return own.Pair(dx, dv);
  };
  const auto add = [taper](Weighted<Pack>* sum, const Share<Pack>& share) {
    Add(share, taper, sum);
  };
  typename Rules::Sums sums;
  for (std::uint32_t q = 0; q < candidates.self; ++q) {
    sums.Each(pair(candidates.list[q]), add);
  }
  alignas(64) float lane_numbers[Pack::size];
  for (std::uint32_t k = 0; k < Pack::size; ++k) lane_numbers[k] = static_cast<float>(k);
  const Pack lane = Pack::load_aligned(lane_numbers);
  for (std::uint32_t q = candidates.self; q < candidates.self_end; ++q) {  // all but oneself
    const std::uint32_t j = candidates.list[q];
    const auto other = lane != Pack(static_cast<float>(j - tile.first));
    sums.Each(pair(j), [&](Weighted<Pack>* sum, const Share<Pack>& share) {
      Add(Share<Pack>{share.value, Where(other, share.weight)}, taper, sum);
    });
  }
  for (std::uint32_t q = candidates.self_end; q < candidates.count; ++q) {
    sums.Each(pair(candidates.list[q]), add);
  }
  const Vec3<Pack> acceleration = own.Finish(sums);
  Store(acceleration.x, tile, job.sums.ax);
  Store(acceleration.y, tile, job.sums.ay);
  Store(acceleration.z, tile, job.sums.az);
  Store(sums.Neighbours(), tile, job.sums.neighbours);
}

// Calls fn(tile) for all tiles of the animals first .. last - 1, row after row.
template <typename Pack, typename Function>
[[gnu::always_inline]] inline void ForEachTile(const PairJob& job, std::uint32_t first,
                                               std::uint32_t last, const Function& fn) {
  const auto line = [&job](int row) {
    return ((row / job.ny + 1) * (job.ny + 2) + row % job.ny + 1) * (job.nx + 2);
  };
  const auto row_end = [&](int row) { return job.start[line(row) + job.nx + 1]; };
  int row = 0;
  for (int rows = job.ny * job.nz; rows > 0;) {  // the first row that ends after `first`
    const int half = rows / 2;
    if (row_end(row + half) <= first) {
      row += half + 1;
      rows -= half + 1;
    } else {
      rows = half;
    }
  }
  for (; first < last; ++row) {
    const std::uint32_t end = row_end(row) < last ? row_end(row) : last;
    while (first < end) {
      const std::uint32_t full = first + std::uint32_t{Pack::size};
      const TileOf tile{first, TileEnd(job, first, full < end ? full : end), row};
      fn(tile);
      first = tile.last;
    }
    first = end;
  }
}

// The animals first .. last - 1. All of it is inlined into the kernel, which knows which of the
// rules' numbers are one and the same.
template <typename Pack, typename Rules, typename Taper>
[[gnu::always_inline]] inline void SumPairs(const PairJob& job, const Rules& rules, Taper taper,
                                            std::uint32_t first, std::uint32_t last,
                                            std::uint32_t* candidate_room) {
  Candidates candidates{candidate_room, 0, 0, 0};
  ForEachTile<Pack>(
      job, first, last, [&](const TileOf& tile) __attribute__((always_inline)) {
        CollectCandidates<Pack>(job, tile, &candidates);
        SumTile<Pack>(job, rules, taper, tile, candidates);
      });
}

}  // namespace
}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_PAIR_KERNEL_INL_H_
