// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The pairs of a shape-constrained swarm (simulate/flock/shape_pairs.h); included once by each
// variant, as near_block_inl.h.
//
// A tile's animals are taken one after the other, lanes holding neighbours: on a surface few of a
// tile's candidates are within reach of each of its animals, and tiles are seldom full. Candidates
// are copied side by side in blocks. For each block all animals' neighbours are sifted out and
// counted first and summed afterwards: gains depend on the counts, and what was just stored in
// small pieces is slow to load. Where one block does not hold all, the blocks are gone through
// twice. Neighbour n of an animal, in the order of the sort, is added to sum n % 8 of eight;
// pair_forces.cc does the same without packs.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SHAPE_KERNEL_INL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SHAPE_KERNEL_INL_H_

#include <cstddef>
#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "simulate/flock/kernels/kernels.h"
#include "simulate/flock/kernels/near_block_inl.h"
#include "simulate/flock/kernels/pair_kernel_inl.h"
#include "simulate/flock/shape_pairs.h"

namespace flocklift {
namespace {

template <typename Pack>
class ShapeTile {
 public:
  ShapeTile(const PairJob& job, const ShapePairs<Pack>& rules) : job_(job), rules_(rules) {}

  void Sum(const TileOf& tile) {
    tile_ = tile;
    for (std::uint32_t a = 0; a < Size(); ++a) animals_[a].left_count = 0;
    for (auto& counts : counts_) Pack(0.0f).store_aligned(counts);
    int blocks = 0;
    Collect([&](bool last) {
      SiftAll();
      CountAll();
      if (++blocks == 1 && last) {
        SetGains();
        AddAll(true, true);
      }
    });
    if (blocks > 1) {
      SetGains();
      bool first = true;
      Collect([&](bool last) {
        SiftAll();
        AddAll(first, last);
        first = false;
      });
    }
    Finish();
  }

 private:
  using ByTerm = typename ShapePairs<Pack>::ByTerm;
  static constexpr std::uint32_t kLanes = Pack::size, kParts = kEight / kLanes;
  static constexpr std::uint32_t kBlock = 128, kColumn = NearBlock<Pack, kBlock, 6>::kColumn;

  struct Animal {
    alignas(32) float sums[3][kEight];
    alignas(32) float left[6][kEight];  // neighbours too few for a pack, for the next block
    std::uint32_t left_count;
    std::uint32_t begin, end;  // in near_
  };

  std::uint32_t Size() const { return tile_.last - tile_.first; }

  template <typename Use>
  void Collect(const Use& use) {
    block_.Collect(
        job_, tile_, [this](const Vec3<Pack>& dx) { return rules_.Felt(dx); }, use);
  }

  static void Copy(const float* from, float* to) {  // eight
    for (std::uint32_t part = 0; part < kEight; part += kLanes) {
      Pack::load_unaligned(from + part).store_unaligned(to + part);
    }
  }

  // The steps are functions of their own: inlined into one another they run out of registers.

  // Lists what is left of the last block and the animals of this one that are within reach, and
  // behind them such as are not, up to the end of a pack.
  [[gnu::noinline]] void SiftAll() {
    const Pack beyond(2 * job_.reach + 1);  // no term reaches as far
    std::uint32_t begin = 0;
    for (std::uint32_t a = 0; a < Size(); ++a) {
      Animal& animal = animals_[a];
      animal.begin = begin;
      if (animal.left_count > 0) {
        for (int k = 0; k < 6; ++k) Copy(animal.left[k], near_[k] + begin);
      }
      animal.end = Sift(a, begin + animal.left_count);
      for (std::uint32_t part = 0; part < kEight; part += kLanes) {
        beyond.store_unaligned(near_[0] + animal.end + part);
      }
      const std::uint32_t unit = begin / kEight;
      begin = (animal.end + kEight - 1) / kEight * kEight;
      owner_[unit] = owner_[unit + 1] = a;
      for (std::uint32_t u = unit + 2; u < begin / kEight; ++u) owner_[u] = a;
    }
    units_ = begin / kEight;
  }
  std::uint32_t Sift(std::uint32_t a, std::uint32_t begin) {
    const std::uint32_t at = tile_.first + a, count = block_.count();
    const Pack x(job_.x[at]), y(job_.y[at]), z(job_.z[at]);
    const float* const from = block_.columns();
    std::size_t end = begin;
    for (std::size_t q = 0; q < count; q += kLanes) {
      const auto load = [&](std::size_t k) { return Pack::load_aligned(from + k * kColumn + q); };
      const Vec3<Pack> dx{load(0) - x, load(1) - y, load(2) - z};
      const std::uint64_t mask = LaneMask(rules_.Felt(dx)) & block_.Others(a, q);
      StoreSetLanes(mask, dx.x, near_[0] + end);
      StoreSetLanes(mask, dx.y, near_[1] + end);
      StoreSetLanes(mask, dx.z, near_[2] + end);
      for (std::size_t k = 3; k < 6; ++k) StoreSetLanes(mask, load(k), near_[k] + end);
      end += static_cast<std::size_t>(__builtin_popcountll(mask));
    }
    return static_cast<std::uint32_t>(end);
  }

  [[gnu::noinline]] void CountAll() {
    for (std::uint32_t a = 0; a < Size(); ++a) {
      std::uint32_t counts[4] = {};
      for (std::uint32_t q = animals_[a].begin; q < animals_[a].end; q += kLanes) {
        const auto load = [&](int k) { return Pack::load_aligned(near_[k] + q); };
        const auto terms = rules_.TermsOf({load(0), load(1), load(2)});
        const auto count = [](const auto& mask) {
          return static_cast<std::uint32_t>(__builtin_popcountll(LaneMask(mask)));
        };
        counts[0] += count(terms.repels);
        counts[1] += count(terms.aligns);
        counts[2] += count(terms.attracts);
        counts[3] += count(terms.spreads);
      }
      for (int n = 0; n < 4; ++n) counts_[n][a] += static_cast<float>(counts[n]);
    }
  }

  ByTerm Counts() const {
    return {Pack::load_aligned(counts_[0]), Pack::load_aligned(counts_[1]),
            Pack::load_aligned(counts_[2]), Pack::load_aligned(counts_[3])};
  }
  void SetGains() {
    const ByTerm gains = rules_.Gains(Counts());
    gains.repel.store_aligned(gains_[0]);
    gains.align.store_aligned(gains_[1]);
    gains.attract.store_aligned(gains_[2]);
    gains.spread.store_aligned(gains_[3]);
  }

  // What every neighbour adds, eight after eight; then each animal's sums of them: of whole eights,
  // and at the end of the tile of all that is left.
  void AddAll(bool first, bool last) {
    ComputeShares();
    for (std::uint32_t a = 0; a < Size(); ++a) {
      Animal& animal = animals_[a];
      const std::uint32_t rest = last ? 0 : (animal.end - animal.begin) % kEight;
      Add((animal.end - rest - animal.begin + kEight - 1) / kEight, first, &animal);
      animal.left_count = rest;
      for (int k = 0; k < 6 && rest > 0; ++k) Copy(near_[k] + animal.end - rest, animal.left[k]);
    }
  }
  [[gnu::noinline]] void ComputeShares() {
    const float* const velocity[3] = {job_.vx + tile_.first, job_.vy + tile_.first,
                                      job_.vz + tile_.first};
    const ShapePairs<Pack> rules = rules_;
    for (std::uint32_t u = 0; u < units_; ++u) {
      const std::uint32_t a = owner_[u];
      const Vec3<Pack> own{Pack(velocity[0][a]), Pack(velocity[1][a]), Pack(velocity[2][a])};
      const ByTerm gains{Pack(gains_[0][a]), Pack(gains_[1][a]), Pack(gains_[2][a]),
                         Pack(gains_[3][a])};
      for (std::uint32_t q = u * kEight; q < (u + 1) * kEight; q += kLanes) {
        const auto load = [&](int k) { return Pack::load_aligned(near_[k] + q); };
        const Vec3<Pack> share = rules.Pair(gains, {load(0), load(1), load(2)},
                                            Vec3<Pack>{load(3), load(4), load(5)} - own);
        share.x.store_aligned(share_[0] + q);
        share.y.store_aligned(share_[1] + q);
        share.z.store_aligned(share_[2] + q);
      }
    }
  }
  void Add(std::uint32_t units, bool first, Animal* animal) {
    const std::uint32_t one = units > 0 ? animal->begin : kNothing,
                        two = units > 1 ? animal->begin + kEight : kNothing;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      for (std::uint32_t part = 0; part < kEight; part += kLanes) {
        const float* const share = share_[axis] + part;
        Pack sum = Pack::load_aligned(share + one);
        if (!first) sum = Pack::load_aligned(animal->sums[axis] + part) + sum;
        sum += Pack::load_aligned(share + two);
        for (std::uint32_t u = 2; u < units; ++u) {
          sum += Pack::load_aligned(share + animal->begin + u * kEight);
        }
        sum.store_aligned(animal->sums[axis] + part);
      }
    }
  }

  void Finish() {
    alignas(64) float total[3][kLanes];
    for (std::uint32_t a = 0; a < kLanes; a += 4) {
      for (std::uint32_t axis = 0; axis < 3; ++axis) {
        Fold(animals_[a].sums[axis], sizeof(Animal) / sizeof(float), total[axis] + a);
      }
    }
    Store(Pack::load_aligned(total[0]), tile_, job_.ax);
    Store(Pack::load_aligned(total[1]), tile_, job_.ay);
    Store(Pack::load_aligned(total[2]), tile_, job_.az);
    Store(rules_.Neighbours(Counts()), tile_, job_.neighbours);
  }

  const PairJob& job_;
  const ShapePairs<Pack> rules_;
  TileOf tile_{};
  NearBlock<Pack, kBlock, 6> block_;
  static constexpr std::uint32_t kRoom = kLanes * (kBlock + 2 * kEight);
  static constexpr std::uint32_t kNothing = kRoom;   // a place where shares are zeros
  alignas(64) float near_[6][kRoom] = {};            // dx, velocities; by animal
  alignas(64) float share_[3][kRoom + kEight] = {};  // of the acceleration; likewise
  std::uint32_t owner_[kRoom / kEight + 2] = {};     // of every eight
  std::uint32_t units_ = 0;                          // eights
  alignas(64) float counts_[4][kLanes],
      gains_[4][kLanes];  // by animal: repel, align, attract, spread
  Animal animals_[kLanes] = {};
};

template <typename Pack>
[[gnu::always_inline]] inline void SumShapePairs(const PairJob& job, const ShapePairs<Pack>& rules,
                                                 std::uint32_t first, std::uint32_t last) {
  ShapeTile<Pack> sums(job, rules);
  ForEachTile<Pack>(job, first, last, [&](const TileOf& tile) { sums.Sum(tile); });
}

}  // namespace
}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SHAPE_KERNEL_INL_H_
