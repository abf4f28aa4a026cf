// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The pairs of animals whose neighbours are listed (simulate/flock/near_lists.h); included once by
// each variant, after it has defined, besides what pair_kernel_inl.h asks for,
//   Vec3<batch> FetchVectors(rows, places)   x, y, z of a pack of rows of 8 numbers, by number
// Lanes hold animals, each with the n-th neighbour of its own list.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_LISTED_KERNEL_INL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_LISTED_KERNEL_INL_H_

#include <cstddef>
#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "simulate/flock/kernels/kernels.h"
#include "simulate/flock/kernels/near_block_inl.h"
#include "simulate/flock/kernels/pair_kernel_inl.h"

namespace flocklift {
namespace {

// The animals first .. last - 1, whose lists they are; rules as of SumPairs (pair_kernel_inl.h), or
// such as add a pair by themselves: rules.Add(dx, dv, &sums).
template <typename Pack, typename Rules, typename Taper>
[[gnu::always_inline]] inline void SumListed(const ListedPairs& listed, const PairSums& to,
                                             const Rules& rules, Taper taper, std::uint32_t first,
                                             std::uint32_t last) {
  constexpr std::uint32_t kVelocity = 4;  // in a row
  const auto add = [taper](Weighted<Pack> * sum, const Share<Pack>& share)
      __attribute__((always_inline)) {
    Add(share, taper, sum);
  };
  const std::uint32_t* begin = listed.begin;
  for (std::uint32_t eight = first; eight < last; eight += kEight, ++begin) {
    for (std::uint32_t part = 0; part < kEight && eight + part < last; part += Pack::size) {
      const std::uint32_t end = eight + part + std::uint32_t{Pack::size};
      const TileOf tile{eight + part, end < last ? end : last, 0};
      std::uint32_t numbers[Pack::size];
      for (std::uint32_t k = 0; k < Pack::size; ++k) numbers[k] = tile.first + k;
      const Vec3<Pack> x = FetchVectors(listed.rows, numbers);
      const Vec3<Pack> v = FetchVectors(listed.rows + kVelocity, numbers);
      const auto own = rules.For(v);
      typename Rules::Sums sums;
      const std::uint32_t* const past = listed.places + kEight * std::size_t{begin[1]};
      for (const std::uint32_t* places = listed.places + kEight * std::size_t{*begin} + part;
           places < past; places += kEight) {
        const Vec3<Pack> dx = FetchVectors(listed.rows, places) - x;
        const Vec3<Pack> dv = FetchVectors(listed.rows + kVelocity, places) - v;
        if constexpr (requires { own.Add(dx, dv, &sums); }) {
          own.Add(dx, dv, &sums);
        } else {
          sums.Each(own.Pair(dx, dv), add);
        }
      }
      const Vec3<Pack> acceleration = own.Finish(sums);
      Store(acceleration.x, tile, to.ax);
      Store(acceleration.y, tile, to.ay);
      Store(acceleration.z, tile, to.az);
      Store(sums.Neighbours(), tile, to.neighbours);
    }
  }
}

}  // namespace
}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_LISTED_KERNEL_INL_H_
