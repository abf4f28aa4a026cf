// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The pairs of a shape-constrained swarm (simulate/flock/shape_pairs.h); included once by each
// variant, as near_block_inl.h.
//
// A tile's animals are taken one after the other, lanes holding neighbours: on a surface few of a
// tile's candidates are within reach of each of its animals, and tiles are seldom full. Neighbour n
// of an animal, in the order of the sort, is added to sum n % 8 of eight; pair_forces.cc does the
// same without packs. Candidates are copied side by side in blocks. For each block all animals'
// neighbours are sifted out first and summed afterwards: what was just stored in small pieces is
// slow to load.

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
    fresh_ = true;
    for (std::uint32_t a = 0; a < Size(); ++a) {
      animals_[a].left_count = 0;
      for (std::uint32_t& count : animals_[a].counts) count = 0;
    }
    block_.Collect(
        job_, tile, [this](const Vec3<Pack>& dx) { return rules_.Felt(dx); },
        [this](bool last) { SumBlock(last); });
    Finish();
  }

 private:
  static constexpr std::uint32_t kLanes = Pack::size, kParts = kEight / kLanes;
  static constexpr std::uint32_t kBlock = 128, kColumn = NearBlock<Pack, kBlock, 6>::kColumn;
  static constexpr std::uint32_t kRows = 12;  // of sums: repulsion, alignment, spread, attraction
  static constexpr std::uint32_t kRepulsion = 0, kAlignment = 3, kSpread = 6, kAttraction = 9;

  struct Animal {
    alignas(32) float sums[kRows][kEight];
    alignas(32) float left[6][kEight];  // neighbours too few for a pack, for the next block
    std::uint32_t left_count;
    std::uint32_t counts[4];   // neighbours that repel, align, spread, attract
    std::uint32_t begin, end;  // in near_
  };

  std::uint32_t Size() const { return tile_.last - tile_.first; }

  // Lists what is left of the last block and the animals of this one that are within reach.
  void Sift(std::uint32_t a, std::uint32_t begin) {
    Animal* const animal = &animals_[a];
    const std::uint32_t at = tile_.first + a, count = block_.count();
    const Pack x(job_.x[at]), y(job_.y[at]), z(job_.z[at]);
    if (!fresh_) {
      for (int k = 0; k < 6; ++k) Copy(animal->left[k], near_[k] + begin);
    }
    const float* const from = block_.columns();
    std::size_t end = begin + animal->left_count;
    block_.Without(a, [&] {
      for (std::size_t q = 0; q < count; q += kLanes) {
        const auto load = [&](std::size_t k) { return Pack::load_aligned(from + k * kColumn + q); };
        const Vec3<Pack> dx{load(0) - x, load(1) - y, load(2) - z};
        const std::uint64_t mask = LaneMask(rules_.Felt(dx));
        StoreSetLanes(mask, dx.x, near_[0] + end);
        StoreSetLanes(mask, dx.y, near_[1] + end);
        StoreSetLanes(mask, dx.z, near_[2] + end);
        for (std::size_t k = 3; k < 6; ++k) StoreSetLanes(mask, load(k), near_[k] + end);
        end += static_cast<std::size_t>(__builtin_popcountll(mask));
      }
    });
    animal->begin = begin;
    animal->end = static_cast<std::uint32_t>(end);
  }

  static void Copy(const float* from, float* to) {  // eight
    for (std::uint32_t part = 0; part < kEight; part += kLanes) {
      Pack::load_unaligned(from + part).store_unaligned(to + part);
    }
  }

  // Of one term, lanes part * kLanes and following of the eight sums.
  static Vec3<Pack> LoadSums(const Animal& animal, std::uint32_t row, std::uint32_t part) {
    const float* const from = animal.sums[row] + part * kLanes;
    return {Pack::load_aligned(from), Pack::load_aligned(from + kEight),
            Pack::load_aligned(from + 2 * kEight)};
  }
  static void StoreSums(const Vec3<Pack>& sums, std::uint32_t row, std::uint32_t part,
                        Animal* animal) {
    float* const to = animal->sums[row] + part * kLanes;
    sums.x.store_aligned(to);
    sums.y.store_aligned(to + kEight);
    sums.z.store_aligned(to + 2 * kEight);
  }

  // Adds the neighbours from near_[..][begin] to near_[..][end - 1], whole packs of eight.
  void Add(std::uint32_t at, std::uint32_t begin, std::uint32_t end, Animal* animal) const {
    const Vec3<Pack> own{Pack(job_.vx[at]), Pack(job_.vy[at]), Pack(job_.vz[at])};
    const Pack zero(0.0f);
    const Vec3<Pack> nothing{zero, zero, zero};
    const auto count = [](const auto& mask) {
      return static_cast<std::uint32_t>(__builtin_popcountll(LaneMask(mask)));
    };
    std::uint32_t repel = 0, align = 0, spread = 0;
    for (std::uint32_t part = 0; part < kParts; ++part) {
      Vec3<Pack> repulsion = nothing, alignment = nothing, spreading = nothing;
      if (fresh_) {
        StoreSums(nothing, kAttraction, part, animal);
      } else {
        repulsion = LoadSums(*animal, kRepulsion, part);
        alignment = LoadSums(*animal, kAlignment, part);
        spreading = LoadSums(*animal, kSpread, part);
      }
      for (std::uint32_t q = begin + part * kLanes; q < end; q += kEight) {
        const auto load = [&](int k) { return Pack::load_aligned(near_[k] + q); };
        const auto shares =
            rules_.Pair({load(0), load(1), load(2)}, Vec3<Pack>{load(3), load(4), load(5)} - own);
        repulsion += shares.repulsion;
        alignment += shares.alignment;
        spreading += shares.spread;
        repel += count(shares.repels);
        align += count(shares.aligns);
        spread += count(shares.spreads);
        if (const std::uint32_t attracted = count(shares.attracts); attracted > 0) {
          animal->counts[3] += attracted;
          StoreSums(LoadSums(*animal, kAttraction, part) + shares.attraction, kAttraction, part,
                    animal);
        }
      }
      StoreSums(repulsion, kRepulsion, part, animal);
      StoreSums(alignment, kAlignment, part, animal);
      StoreSums(spreading, kSpread, part, animal);
    }
    animal->counts[0] += repel;
    animal->counts[1] += align;
    animal->counts[2] += spread;
  }

  [[gnu::noinline]] void SumBlock(bool last) {
    std::uint32_t begin = 0;
    for (std::uint32_t a = 0; a < Size(); ++a) {
      Sift(a, begin);
      begin = (animals_[a].end + kEight - 1) / kEight * kEight;
    }
    const float beyond = 2 * job_.reach + 1;  // no term reaches as far
    for (std::uint32_t a = 0; a < Size(); ++a) {
      Animal& animal = animals_[a];
      std::uint32_t rest = (animal.end - animal.begin) % kEight;
      if (last) {
        for (; rest > 0 && rest < kEight; ++rest) near_[0][animal.end++] = beyond;
        rest = 0;
      }
      Add(tile_.first + a, animal.begin, animal.end - rest, &animal);
      animal.left_count = rest;
      for (int k = 0; k < 6 && rest > 0; ++k) Copy(near_[k] + animal.end - rest, animal.left[k]);
    }
    fresh_ = false;
  }

  void Finish() {
    alignas(64) float total[kRows][kLanes], counts[4][kLanes];
    for (std::uint32_t a = 0; a < kLanes; a += 4) {
      for (std::uint32_t row = 0; row < kRows; ++row) {
        Fold(animals_[a].sums[row], sizeof(Animal) / sizeof(float), total[row] + a);
      }
      for (std::uint32_t k = a; k < a + 4; ++k) {
        for (int n = 0; n < 4; ++n) counts[n][k] = static_cast<float>(animals_[k].counts[n]);
      }
    }
    const auto sum = [&](std::uint32_t row, int n) -> Weighted<Pack> {
      return {{Pack::load_aligned(total[row]), Pack::load_aligned(total[row + 1]),
               Pack::load_aligned(total[row + 2])},
              Pack::load_aligned(counts[n])};
    };
    typename ShapePairs<Pack>::Sums sums;
    sums.repulsion = sum(kRepulsion, 0);
    sums.alignment = sum(kAlignment, 1);
    sums.spread = sum(kSpread, 2);
    sums.attraction = sum(kAttraction, 3);
    const Vec3<Pack> acceleration = rules_.Finish(sums);
    Store(acceleration.x, tile_, job_.ax);
    Store(acceleration.y, tile_, job_.ay);
    Store(acceleration.z, tile_, job_.az);
    Store(sums.Neighbours(), tile_, job_.neighbours);
  }

  const PairJob& job_;
  const ShapePairs<Pack>& rules_;
  TileOf tile_{};
  bool fresh_ = true;  // nothing has been summed yet
  NearBlock<Pack, kBlock, 6> block_;
  alignas(64) float near_[6][kLanes * (kBlock + 2 * kEight)] = {};  // dx, velocities; by animal
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
