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

// NearReach::Holds (simulate/flock/near_lists.h).
template <typename Pack>
struct NearTest {
  NearTest(float straight, float manhattan_reach)
      : squared(straight * straight), manhattan(manhattan_reach) {}
  auto Near(const Vec3<Pack>& dx) const {
    return (Dot(dx, dx) <= squared) |
           (xsimd::abs(dx.x) + xsimd::abs(dx.y) + xsimd::abs(dx.z) < manhattan);
  }
  Pack squared, manhattan;
};

// Who may be near a tile's animals: where they are, side by side in three columns of the job, and
// their numbers. The tile's own begin at `self`. To the end of the last pack x is no number, so
// that nobody is near.
template <typename Pack>
class ListCandidates {
 public:
  explicit ListCandidates(const ListJob& job) : job_(job) {}

  [[gnu::noinline]] void Collect(const TileOf& tile) {
    const PairJob& pairs = job_.pairs;
    const Interval box[3] = {Bounds(pairs.x, tile.first, tile.last),
                             Bounds(pairs.y, tile.first, tile.last),
                             Bounds(pairs.z, tile.first, tile.last)};
    count_ = 0;
    ForEachRun(pairs, tile, box[0], [&](std::uint32_t first, std::uint32_t last, bool own_row) {
      if (!own_row) return Append(first, last, box);
      Append(first, tile.first, box);
      self_ = count_;
      Append(tile.first, last, box);
    });
    Pack(__builtin_nanf("")).store_unaligned(Column(0) + count_);
  }

  std::uint32_t count() const { return count_; }
  std::uint32_t self() const { return self_; }
  Vec3<Pack> Positions(std::uint32_t from) const {
    return {Pack::load_unaligned(Column(0) + from), Pack::load_unaligned(Column(1) + from),
            Pack::load_unaligned(Column(2) + from)};
  }

 private:
  float* Column(std::size_t axis) const { return job_.columns + axis * job_.column; }

  // Those of [first, last) that are near the box.
  void Append(std::uint32_t first, std::uint32_t last, const Interval* box) {
    constexpr std::uint32_t kLanes = Pack::size;
    const NearTest<Pack> test(job_.margin * job_.straight, job_.margin * job_.manhattan);
    for (std::uint32_t j = first; j < last; j += kLanes) {
      const Vec3<Pack> x{Pack::load_unaligned(job_.pairs.x + j),
                         Pack::load_unaligned(job_.pairs.y + j),
                         Pack::load_unaligned(job_.pairs.z + j)};
      const std::uint32_t left = last - j;
      const std::uint64_t all = (std::uint64_t{1} << (left < 63 ? left : 63)) - 1;  // no branch
      const std::uint64_t mask =
          all &
          LaneMask(test.Near({Outside(x.x, box[0]), Outside(x.y, box[1]), Outside(x.z, box[2])}));
      StoreSetLanes(mask, x.x, Column(0) + count_);
      StoreSetLanes(mask, x.y, Column(1) + count_);
      StoreSetLanes(mask, x.z, Column(2) + count_);
      count_ += AppendSetBits(mask, j, job_.candidates + count_);
    }
  }

  const ListJob& job_;
  std::uint32_t count_ = 0, self_ = 0;
};

// The list of animal a of a tile, as numbers of candidates, in job.near; returns its length.
template <typename Pack>
std::uint32_t ListOne(const ListJob& job, const TileOf& tile, std::uint32_t a,
                      const ListCandidates<Pack>& candidates) {
  const std::uint32_t at = tile.first + a, self = candidates.self() + a;
  const Vec3<Pack> x{Pack(job.pairs.x[at]), Pack(job.pairs.y[at]), Pack(job.pairs.z[at])};
  const NearTest<Pack> test(job.straight, job.manhattan);
  std::uint32_t count = 0;
  for (std::uint32_t q = 0; q < candidates.count(); q += Pack::size) {
    std::uint64_t near = LaneMask(test.Near(candidates.Positions(q) - x));
    const std::uint32_t lane = self - q;
    near &= ~(std::uint64_t{lane < Pack::size ? 1U : 0U} << (lane % Pack::size));
    count += AppendSetBits(near, q, job.near + count);
  }
  return count;
}

// Eight lists side by side, as they are filled.
class EightLists {
 public:
  explicit EightLists(const ListJob& job) : job_(job) {}

  // Whether lists of up to `most` have room, in these eight and the next.
  bool HaveRoom(std::uint32_t most) const {
    const std::size_t longest = longest_ < most ? most : longest_;
    return kEight * (*begin_ + longest + most) <= job_.room;
  }
  void Append(const std::uint32_t* candidates, std::uint32_t count) {
    std::uint32_t* const to = job_.places + kEight * std::size_t{*begin_} + size_;
    for (std::uint32_t n = 0; n < count; ++n) to[kEight * n] = candidates[job_.near[n]];
    length_[size_] = count;
    longest_ = longest_ < count ? count : longest_;
    if (++size_ == kEight) Close();
  }
  void Close() {
    std::uint32_t* const to = job_.places + kEight * std::size_t{*begin_};
    for (; size_ < kEight; ++size_) length_[size_] = 0;
    for (std::uint32_t a = 0; a < kEight; ++a) {
      for (std::uint32_t n = length_[a]; n < longest_; ++n) to[kEight * n + a] = job_.nobody;
    }
    begin_[1] = *begin_ + longest_;
    ++begin_;
    size_ = longest_ = 0;
  }
  std::uint32_t size() const { return size_; }
  std::uint32_t closed() const { return static_cast<std::uint32_t>(begin_ - job_.begin); }

 private:
  const ListJob& job_;
  std::uint32_t* begin_ = job_.begin;
  std::uint32_t size_ = 0, longest_ = 0, length_[kEight] = {};
};

template <typename Pack>
std::uint32_t ListTiles(const ListJob& job, std::uint32_t first, std::uint32_t last) {
  ListCandidates<Pack> candidates(job);
  EightLists lists(job);
  bool full = false;
  ForEachTile<Pack>(job.pairs, first, last, [&](const TileOf& tile) {
    if (full) return;
    candidates.Collect(tile);
    full = !lists.HaveRoom(candidates.count());
    if (full) return;
    for (std::uint32_t a = 0; a < tile.last - tile.first; ++a) {
      lists.Append(job.candidates, ListOne<Pack>(job, tile, a, candidates));
    }
  });
  if (full) return first + kEight * lists.closed();
  if (lists.size() > 0) lists.Close();
  return last;
}

}  // namespace
}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_LIST_KERNEL_INL_H_
