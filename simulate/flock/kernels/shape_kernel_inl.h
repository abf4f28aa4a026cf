// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The pairs of a shape-constrained swarm (simulate/flock/shape_pairs.h) from lists of neighbours
// (simulate/flock/near_lists.h); included once by each variant, after it has defined, besides what
// pair_kernel_inl.h asks for,
//   Vec3<batch> FetchVectors(rows, places)   x, y, z of a pack of rows of 8 numbers, by number
// Lanes hold animals, each with the n-th neighbour of its own list.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SHAPE_KERNEL_INL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SHAPE_KERNEL_INL_H_

#include <cstddef>
#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "simulate/flock/kernels/kernels.h"
#include "simulate/flock/kernels/near_block_inl.h"
#include "simulate/flock/shape_pairs.h"

namespace flocklift {
namespace {

template <typename Pack>
[[gnu::always_inline]] inline void SumListedShapes(const ShapeJob& job,
                                                   const ShapePairs<Pack>& rules,
                                                   std::uint32_t first, std::uint32_t last) {
  constexpr std::uint32_t kVelocity = 4;  // in a row
  const std::uint32_t* begin = job.begin;
  for (std::uint32_t eight = first; eight < last; eight += kEight, ++begin) {
    for (std::uint32_t part = 0; part < kEight && eight + part < last; part += Pack::size) {
      const std::uint32_t end = eight + part + std::uint32_t{Pack::size};
      const TileOf tile{eight + part, end < last ? end : last, 0};
      std::uint32_t own[Pack::size];
      for (std::uint32_t k = 0; k < Pack::size; ++k) own[k] = tile.first + k;
      const Vec3<Pack> x = FetchVectors(job.rows, own);
      const Vec3<Pack> v = FetchVectors(job.rows + kVelocity, own);
      typename ShapePairs<Pack>::Sums sums;
      const std::uint32_t* const past = job.places + kEight * std::size_t{begin[1]};
      for (const std::uint32_t* places = job.places + kEight * std::size_t{*begin} + part;
           places < past; places += kEight) {
        rules.Add(FetchVectors(job.rows, places) - x,
                  FetchVectors(job.rows + kVelocity, places) - v, &sums);
      }
      const Vec3<Pack> acceleration = rules.Finish(sums);
      Store(acceleration.x, tile, job.ax);
      Store(acceleration.y, tile, job.ay);
      Store(acceleration.z, tile, job.az);
      Store(sums.Neighbours(), tile, job.neighbours);
    }
  }
}

}  // namespace
}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SHAPE_KERNEL_INL_H_
