// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the kernels share that take a tile's animals one after the other, lanes holding neighbours:
// the tile's candidates, copied side by side in blocks, and eight sums made one. Included once by
// each variant, after it has defined, besides what pair_kernel_inl.h asks for,
//   void StoreSetLanes(mask, batch, to)   lanes k of the set bits k, one after the other

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_NEAR_BLOCK_INL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_NEAR_BLOCK_INL_H_

#include <xmmintrin.h>

#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "simulate/flock/kernels/kernels.h"
#include "simulate/flock/kernels/pair_kernel_inl.h"

namespace flocklift {
namespace {

constexpr std::uint32_t kEight = 8;  // sums of a term; numbers of a list's unit

// Up to kRoom candidates of a tile, in the order of the sort, and where they are.
template <typename Pack, std::uint32_t kRoom>
class NearBlock {
 public:
  static constexpr std::uint32_t kColumn = kRoom + 2 * kEight;

  std::uint32_t count() const { return count_; }
  // x, y, z: the next is kColumn further. From their end to the end of its pack x is no number, so
  // that nobody is near.
  const float* columns() const { return columns_[0]; }
  // Where they are in the job's arrays.
  const std::uint32_t* numbers() const { return numbers_; }

  // All lanes of the pack of candidates from number q on but that of animal a of the tile, which is
  // no neighbour of itself.
  std::uint64_t Others(std::uint32_t a, std::size_t q) const {
    const std::size_t lane = self_[a] - q;
    return ~(std::uint64_t{lane < kLanes ? 1U : 0U} << (lane % kLanes));
  }

  // Takes in everybody around a tile who is felt, felt(dx), at the nearest point of the tile's box
  // (no animal of the tile is nearer, rounding included), or who is in the sample. Calls
  // use(last) whenever the block is full and, with true, at the end.
  template <typename Felt, typename Use>
  void Collect(const PairJob& job, const TileOf& tile, const Felt& felt, const Use& use) {
    const Interval box[3] = {Bounds(job.x, tile.first, tile.last),
                             Bounds(job.y, tile.first, tile.last),
                             Bounds(job.z, tile.first, tile.last)};
    const RowSample sample = job.sample != nullptr ? job.sample[tile.row] : RowSample{1, 0};
    const auto flush = [&] {
      Close();
      use(false);
      Empty();
    };
    Empty();
    ForEachRun(job, tile, box[0], [&](std::uint32_t first, std::uint32_t last, bool own_row) {
      if (sample.stride > 1) {
        ForEachSampled(sample, first, last, [&](std::uint32_t j) {
          if (count_ == kRoom) flush();
          AppendOne(job, tile, j);
        });
      } else if (own_row) {
        AppendNear(job, first, tile.first, box, felt, flush);
        if (count_ + kLanes > kRoom) flush();
        for (std::uint32_t j = tile.first; j < tile.last; ++j) AppendOne(job, tile, j);
        AppendNear(job, tile.last, last, box, felt, flush);
      } else {
        AppendNear(job, first, last, box, felt, flush);
      }
    });
    Close();
    use(true);
  }

 private:
  static constexpr std::uint32_t kLanes = Pack::size;
  static constexpr std::uint32_t kNobody = kRoom + kEight;  // a place that no candidate takes

  void Empty() {
    count_ = 0;
    for (std::uint32_t& place : self_) place = kNobody;
  }
  void Close() {
    for (std::uint32_t q = count_; q < count_ + kEight; ++q) columns_[0][q] = __builtin_nanf("");
  }

  template <typename Felt, typename Flush>
  void AppendNear(const PairJob& job, std::uint32_t first, std::uint32_t last, const Interval* box,
                  const Felt& felt, const Flush& flush) {
    const float *const px = job.x, *const py = job.y, *const pz = job.z;
    std::size_t count = count_;
    for (std::uint32_t j = first; j < last; j += kLanes) {
      if (count + kLanes > kRoom) {
        count_ = static_cast<std::uint32_t>(count);
        flush();
        count = count_;
      }
      const Pack x = Pack::load_unaligned(px + j), y = Pack::load_unaligned(py + j),
                 z = Pack::load_unaligned(pz + j);
      const Vec3<Pack> dx{Outside(x, box[0]), Outside(y, box[1]), Outside(z, box[2])};
      const std::uint32_t left = last - j;
      const std::uint64_t all = (std::uint64_t{1} << (left < 63 ? left : 63)) - 1;  // no branch
      const std::uint64_t mask = LaneMask(felt(dx)) & all;
      StoreSetLanes(mask, x, columns_[0] + count);
      StoreSetLanes(mask, y, columns_[1] + count);
      StoreSetLanes(mask, z, columns_[2] + count);
      count += AppendSetBits(mask, j, numbers_ + count);
    }
    count_ = static_cast<std::uint32_t>(count);
  }
  void AppendOne(const PairJob& job, const TileOf& tile, std::uint32_t j) {
    const float* const from[3] = {job.x, job.y, job.z};
    for (int k = 0; k < 3; ++k) columns_[k][count_] = from[k][j];
    numbers_[count_] = j;
    if (j - tile.first < tile.last - tile.first) self_[j - tile.first] = count_;
    ++count_;
  }

  std::uint32_t count_ = 0;
  std::uint32_t self_[kLanes];  // where the tile's own animals are
  alignas(64) float columns_[3][kColumn];
  std::uint32_t numbers_[kColumn] = {};
};

// Eight sums to one: k and k + 4, then k and k + 2, then both. For four animals, whose sums begin
// at `sums` and follow each other at `stride`.
inline void Fold(const float* sums, std::uint32_t stride, float* four) {
  const auto halves = [&](std::uint32_t animal) {
    const float* const eight = sums + animal * stride;
    return _mm_add_ps(_mm_load_ps(eight), _mm_load_ps(eight + 4));
  };
  const auto quarters = [&](std::uint32_t animal) {
    const __m128 f = halves(animal), g = halves(animal + 1);
    return _mm_add_ps(_mm_movelh_ps(f, g), _mm_movehl_ps(g, f));
  };
  const __m128 u = quarters(0), v = quarters(2);
  _mm_store_ps(four, _mm_add_ps(_mm_shuffle_ps(u, v, 0x88), _mm_shuffle_ps(u, v, 0xDD)));
}

}  // namespace
}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_NEAR_BLOCK_INL_H_
