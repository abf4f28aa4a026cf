// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The loop over pairs of every kernel; included once by each variant, after it has defined
//   std::uint64_t LaneMask(batch_bool)                              bit k: lane k
//   std::uint32_t AppendSetBits(mask, base, list)                   list base + k; how many
//   void StoreSetLanes(mask, batch, to)                             likewise the lanes themselves
//   __m128 FoldToFour(const batch*)                                 lanes k and k + 4 of eight
//   added
// Everything lives in an anonymous namespace (kernels.h says why). What the pairs do to each other
// is the rules' business: BoidsPairs, ZonePairs, SteerPairs.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_PAIR_KERNEL_INL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_PAIR_KERNEL_INL_H_

#include <xmmintrin.h>

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

// Appends those of [first, last) that the row samples, wherever they are.
void AppendSample(const RowSample& sample, std::uint32_t first, std::uint32_t last,
                  Candidates* candidates) {
  const std::uint32_t past = first % sample.stride;
  const std::uint32_t way =
      sample.phase >= past ? sample.phase - past : sample.phase + sample.stride - past;
  for (std::uint32_t j = first + way; j < last; j += sample.stride) {
    candidates->list[candidates->count++] = j;
  }
}

// The nine runs of cells around a tile, in the order of the sort.
template <typename Pack>
[[gnu::noinline]] void CollectCandidates(const PairJob& job, const TileOf& tile,
                                         Candidates* candidates) {
  const Interval box[3] = {Bounds(job.x, tile.first, tile.last),
                           Bounds(job.y, tile.first, tile.last),
                           Bounds(job.z, tile.first, tile.last)};
  const int a0 = CellX(job, box[0].low), a1 = CellX(job, box[0].high);
  const float squared_reach = job.reach * job.reach;
  const RowSample sample = job.sample != nullptr ? job.sample[tile.row] : RowSample{1, 0};
  const auto append = [&](std::uint32_t first, std::uint32_t last) {
    if (sample.stride > 1) {
      AppendSample(sample, first, last, candidates);
    } else {
      AppendNear<Pack>(job, first, last, box, squared_reach, candidates);
    }
  };
  candidates->count = 0;
  const int row_b = tile.row % job.ny, row_c = tile.row / job.ny;
  for (int dc = 0; dc <= 2; ++dc) {
    for (int db = 0; db <= 2; ++db) {
      const int line = ((row_c + dc) * (job.ny + 2) + row_b + db) * (job.nx + 2);
      const std::uint32_t run_first = job.start[line + a0 - 1];
      const std::uint32_t run_last = job.start[line + a1 + 2];
      if (dc == 1 && db == 1) {
        append(run_first, tile.first);
        candidates->self = candidates->count;
        append(tile.first, tile.last);
        candidates->self_end = candidates->count;
        append(tile.last, run_last);
      } else {
        append(run_first, run_last);
      }
    }
  }
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
  Store(acceleration.x, tile, job.ax);
  Store(acceleration.y, tile, job.ay);
  Store(acceleration.z, tile, job.az);
  Store(sums.Neighbours(), tile, job.neighbours);
}

// The tile's animals one after the other, lanes holding neighbours: where few of a tile's
// candidates are within reach of each of its animals, or tiles are seldom full, this does far less.
// Neighbour n of an animal, in the order of the sort, is added to sum n % 8 of eight;
// pair_forces.cc does the same without packs. Candidates are taken in blocks, copied side by side
// first.
template <typename Pack, typename Rules, typename Taper>
[[gnu::always_inline]] inline void SumTileByAnimal(const PairJob& job, const Rules& rules,
                                                   Taper taper, const TileOf& tile,
                                                   const Candidates& candidates) {
  constexpr std::uint32_t kLanes = Pack::size, kEight = 8, kParts = kEight / kLanes;
  constexpr std::uint32_t kBlock = 256, kTerms = Rules::kTerms;
  // Of an animal between one block and the next.
  struct State {
    alignas(32) float sums[4 * kTerms][kEight];
    float waiting[6][kEight];  // neighbours too few for all lanes
    std::uint32_t count;       // of those
  };
  State states[kLanes];
  alignas(64) float column[6][kBlock + kEight];    // of the block's candidates: x, y, z, vx, vy, vz
  alignas(64) float near[6][kBlock + 3 * kEight];  // of those within reach: dx, dv
  const float* const from[6] = {job.x, job.y, job.z, job.vx, job.vy, job.vz};
  const Pack squared_reach = Pack(job.reach * job.reach);
  const float beyond = 2 * job.reach + 1;  // no term reaches as far
  const auto add = [taper](Weighted<Pack>* sum, const Share<Pack>& share) {
    Add(share, taper, sum);
  };
  const auto take = [&](std::uint32_t at, typename Rules::Sums* sums) {
    for (std::uint32_t part = 0; part < kParts; ++part) {
      const auto load = [&](int k) { return Pack::load_unaligned(near[k] + at + part * kLanes); };
      sums[part].Each(rules.Pair({load(0), load(1), load(2)}, {load(3), load(4), load(5)}), add);
    }
  };
  alignas(64) float total[4 * kTerms][kLanes];
  for (auto& row : total) Pack(0.0f).store_aligned(row);
  const std::uint32_t size = tile.last - tile.first;
  for (std::uint32_t begin = 0; begin < candidates.count; begin += kBlock) {
    const std::uint32_t rest = candidates.count - begin, count = rest < kBlock ? rest : kBlock;
    for (std::uint32_t q = 0; q < count; ++q) {
      const std::uint32_t j = candidates.list[begin + q];
      for (int k = 0; k < 6; ++k) column[k][q] = from[k][j];
    }
    for (std::uint32_t q = count; q < count + kEight; ++q) {
      column[0][q] = __builtin_nanf("");  // near nobody
      for (int k = 1; k < 6; ++k) column[k][q] = 0;
    }
    for (std::uint32_t a = 0; a < size; ++a) {
      State& state = states[a];
      std::uint32_t self = candidates.self;  // where the animal is among its own candidates
      if (candidates.self_end - self == size) {
        self += a;
      } else {  // a sample; beyond all if it is not in there
        while (self < candidates.self_end && candidates.list[self] != tile.first + a) ++self;
        if (self == candidates.self_end) self = candidates.count + kBlock;
      }
      self -= begin;  // in the block, or wraps
      Pack own[6];
      for (int k = 0; k < 6; ++k) own[k] = Pack(from[k][tile.first + a]);
      std::uint32_t found = begin > 0 ? state.count : 0;
      for (int k = 0; k < 6; ++k) {
        for (std::uint32_t q = 0; q < found; ++q) near[k][q] = state.waiting[k][q];
      }
      for (std::uint32_t q = 0; q < count; q += kLanes) {
        Pack offset[6];
        for (int k = 0; k < 3; ++k) offset[k] = Pack::load_aligned(column[k] + q) - own[k];
        std::uint64_t mask = LaneMask(
            offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2] <= squared_reach);
        mask &= self - q < kLanes ? ~(std::uint64_t{1} << (self - q)) : ~std::uint64_t{0};
        for (int k = 3; k < 6; ++k) offset[k] = Pack::load_aligned(column[k] + q) - own[k];
        for (int k = 0; k < 6; ++k) StoreSetLanes(mask, offset[k], near[k] + found);
        found += static_cast<std::uint32_t>(__builtin_popcountll(mask));
      }
      typename Rules::Sums sums[kParts];
      const auto each_column = [&sums](const auto& fn) {
        for (std::uint32_t part = 0; part < kParts; ++part) {
          std::uint32_t at = 0;
          sums[part].All([&](Weighted<Pack>* sum) {
            for (Pack* pack : {&sum->value.x, &sum->value.y, &sum->value.z, &sum->weight}) {
              fn(at++, part, pack);
            }
          });
        }
      };
      if (begin > 0) {
        each_column([&state](std::uint32_t row, std::uint32_t part, Pack* pack) {
          *pack = Pack::load_aligned(state.sums[row] + part * kLanes);
        });
      }
      std::uint32_t at = 0;
      for (; at + kEight <= found; at += kEight) take(at, sums);
      if (begin + kBlock < candidates.count) {
        state.count = found - at;
        for (int k = 0; k < 6; ++k) {
          for (std::uint32_t q = 0; q < state.count; ++q) state.waiting[k][q] = near[k][at + q];
        }
        each_column([&state](std::uint32_t row, std::uint32_t part, Pack* pack) {
          pack->store_aligned(state.sums[row] + part * kLanes);
        });
        continue;
      }
      if (at < found) {
        for (std::uint32_t q = found; q < at + kEight; ++q) {
          near[0][q] = beyond;
          for (int k = 1; k < 6; ++k) near[k][q] = 0;
        }
        take(at, sums);
      }
      // Eight sums to one: k and k + 4, then k and k + 2, then both. Animals go back to lanes.
      Pack columns[4 * kTerms][kParts];
      each_column([&columns](std::uint32_t row, std::uint32_t part, Pack* pack) {
        columns[row][part] = *pack;
      });
      for (std::uint32_t row = 0; row < 4 * kTerms; row += 4) {
        __m128 x = FoldToFour(columns[row]), y = FoldToFour(columns[row + 1]),
               z = FoldToFour(columns[row + 2]), w = FoldToFour(columns[row + 3]);
        _MM_TRANSPOSE4_PS(x, y, z, w);
        alignas(16) float four[4];
        _mm_store_ps(four, _mm_add_ps(_mm_add_ps(x, z), _mm_add_ps(y, w)));
        for (std::uint32_t k = 0; k < 4; ++k) total[row + k][a] = four[k];
      }
    }
  }
  typename Rules::Sums sums;
  std::uint32_t term = 0;
  sums.All([&](Weighted<Pack>* sum) {
    const auto load = [&](int k) { return Pack::load_aligned(total[4 * term + k]); };
    *sum = {{load(0), load(1), load(2)}, load(3)};
    ++term;
  });
  const Vec3<Pack> acceleration = rules.Finish(sums);
  Store(acceleration.x, tile, job.ax);
  Store(acceleration.y, tile, job.ay);
  Store(acceleration.z, tile, job.az);
  Store(sums.Neighbours(), tile, job.neighbours);
}

// The animals first .. last - 1, row after row. All of it is inlined into the kernel, which knows
// which of the rules' numbers are one and the same.
template <typename Pack, typename Rules, typename Taper>
[[gnu::always_inline]] inline void SumPairs(const PairJob& job, const Rules& rules, Taper taper,
                                            std::uint32_t first, std::uint32_t last,
                                            std::uint32_t* candidate_room) {
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
  Candidates candidates{candidate_room, 0, 0, 0};
  for (; first < last; ++row) {
    const std::uint32_t end = row_end(row) < last ? row_end(row) : last;
    while (first < end) {
      const std::uint32_t full = first + std::uint32_t{Pack::size};
      const TileOf tile{first, TileEnd(job, first, full < end ? full : end), row};
      CollectCandidates<Pack>(job, tile, &candidates);
      if constexpr (requires { Rules::kByAnimal; }) {
        SumTileByAnimal<Pack>(job, rules, taper, tile, candidates);
      } else {
        SumTile<Pack>(job, rules, taper, tile, candidates);
      }
      first = tile.last;
    }
    first = end;
  }
}

}  // namespace
}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_PAIR_KERNEL_INL_H_
