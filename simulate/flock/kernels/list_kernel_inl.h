// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Writes out who is near whom (simulate/flock/near_lists.h); included once by each variant, as
// pair_kernel_inl.h. A tile's animals are taken one after the other, lanes holding its candidates.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_LIST_KERNEL_INL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_LIST_KERNEL_INL_H_

#include <cstddef>
#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "simulate/flock/kernels/kernels.h"
#include "simulate/flock/kernels/near_block_inl.h"
#include "simulate/flock/kernels/pair_kernel_inl.h"

namespace flocklift {
namespace {

// Where the candidates are, side by side: 3 columns. To the end of the last pack x is no number, so
// that nobody is near.
template <typename Pack>
void FetchCandidates(const ListJob& job, const Candidates& candidates, std::size_t column) {
  const float* const from[3] = {job.pairs.x, job.pairs.y, job.pairs.z};
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    float* const to = job.columns + axis * column;
    for (std::uint32_t q = 0; q < candidates.count; ++q) to[q] = from[axis][candidates.list[q]];
  }
  Pack(__builtin_nanf("")).store_unaligned(job.columns + candidates.count);
}

// The list of animal a of a tile, written to `list`, with up to a pack more; returns its length.
template <typename Pack>
std::size_t ListOne(const ListJob& job, const TileOf& tile, std::uint32_t a,
                    const Candidates& candidates, std::size_t column, std::uint32_t* list) {
  const std::uint32_t at = tile.first + a, self = candidates.self + a;
  const Pack x(job.pairs.x[at]), y(job.pairs.y[at]), z(job.pairs.z[at]);
  const Pack squared_reach(job.straight * job.straight), manhattan(job.manhattan);
  std::size_t count = 0;
  for (std::uint32_t q = 0; q < candidates.count; q += Pack::size) {
    const float* const from = job.columns + q;
    const Vec3<Pack> dx{Pack::load_unaligned(from) - x, Pack::load_unaligned(from + column) - y,
                        Pack::load_unaligned(from + 2 * column) - z};
    std::uint64_t near =
        LaneMask((Dot(dx, dx) <= squared_reach) |
                 (xsimd::abs(dx.x) + xsimd::abs(dx.y) + xsimd::abs(dx.z) < manhattan));
    const std::uint32_t lane = self - q;
    near &= ~(std::uint64_t{lane < Pack::size ? 1U : 0U} << (lane % Pack::size));
    count += AppendSetBits(near, q, list + count);
  }
  for (std::size_t n = 0; n < count; ++n) list[n] = candidates.list[list[n]];
  return count;
}

template <typename Pack>
std::uint32_t ListTiles(const ListJob& job, std::uint32_t first, std::uint32_t last) {
  Candidates candidates{job.candidates, 0, 0, 0};
  std::uint32_t next = first;
  bool full = false;
  ForEachTile<Pack>(job.pairs, first, last, [&](const TileOf& tile) {
    if (full) return;
    CollectCandidates<Pack>(job.pairs, tile, &candidates);
    const std::uint32_t animals = tile.last - tile.first;
    std::size_t end = job.begin[next - first];
    full = end + std::size_t{animals} * (candidates.count + 2 * kEight) > job.room;
    if (full) return;
    const std::size_t column = candidates.count + kEight;
    FetchCandidates<Pack>(job, candidates, column);
    for (std::uint32_t a = 0; a < animals; ++a) {
      std::uint32_t* const list = job.places + end;
      const std::size_t count = ListOne<Pack>(job, tile, a, candidates, column, list);
      for (std::uint32_t n = 0; n < kEight; ++n) list[count + n] = job.nobody;
      end += (count + kEight - 1) / kEight * kEight;
      const std::size_t begin = job.begin[next - first];
      for (std::size_t unit = begin / kEight; unit < end / kEight; ++unit) job.owner[unit] = next;
      job.begin[++next - first] = static_cast<std::uint32_t>(end);
    }
  });
  return next;
}

}  // namespace
}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_LIST_KERNEL_INL_H_
