// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The pairs of a shape-constrained swarm (simulate/flock/shape_pairs.h); included once by each
// variant, after it has defined, besides what pair_kernel_inl.h asks for,
//   void StoreSetLanes(mask, batch, to)   lanes k of the set bits k, one after the other
//
// A tile's animals are taken one after the other, lanes holding neighbours: on a surface few of a
// tile's candidates are within reach of each of its animals, and tiles are seldom full. Neighbour n
// of an animal, in the order of the sort, is added to sum n % 8 of eight; pair_forces.cc does the
// same without packs. Candidates are copied side by side in blocks. For each block all animals'
// neighbours are sifted out first and summed afterwards: what was just stored in small pieces is
// slow to load.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SHAPE_KERNEL_INL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SHAPE_KERNEL_INL_H_

#include <xmmintrin.h>

#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "simulate/flock/kernels/kernels.h"
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
    Empty();
    Collect();
    SumBlock(true);
    Finish();
  }

 private:
  static constexpr std::uint32_t kLanes = Pack::size, kEight = 8, kParts = kEight / kLanes;
  static constexpr std::uint32_t kBlock = 128;
  static constexpr std::uint32_t kRows = 12;  // of sums: repulsion, alignment, spread, attraction
  static constexpr std::uint32_t kRepulsion = 0, kAlignment = 3, kSpread = 6, kAttraction = 9;
  static constexpr std::uint32_t kNobody = 0xFFFFFF00U;

  struct Animal {
    alignas(32) float sums[kRows][kEight];
    alignas(32) float left[6][kEight];  // neighbours too few for a pack, for the next block
    std::uint32_t left_count;
    std::uint32_t counts[4];   // neighbours that repel, align, spread, attract
    std::uint32_t self;        // where the animal is in the block
    std::uint32_t begin, end;  // in near_
  };

  std::uint32_t Size() const { return tile_.last - tile_.first; }
  // Bit k, or one beyond all lanes: without a branch, which would often be foreseen wrongly.
  static std::uint64_t Bit(std::uint32_t k) { return std::uint64_t{1} << (k < 63 ? k : 63); }
  const float* Column(int k) const {
    const float* const all[6] = {job_.x, job_.y, job_.z, job_.vx, job_.vy, job_.vz};
    return all[k];
  }

  // ---- candidates -------------------------------------------------------------------------------

  void Empty() {
    count_ = 0;
    for (std::uint32_t a = 0; a < Size(); ++a) animals_[a].self = kNobody;
  }
  void MakeRoom(std::uint32_t more) {
    if (count_ + more <= kBlock) return;
    SumBlock(false);
    Empty();
  }

  // Those of [first, last) that the nearest point of the tile's box would feel: no animal of the
  // tile is nearer, rounding included.
  void AppendNear(std::uint32_t first, std::uint32_t last, const Interval* box) {
    const float *const px = job_.x, *const py = job_.y, *const pz = job_.z;
    const float *const vx = job_.vx, *const vy = job_.vy, *const vz = job_.vz;
    std::uint32_t count = count_;
    for (std::uint32_t j = first; j < last; j += kLanes) {
      if (count + kLanes > kBlock) {
        count_ = count;
        MakeRoom(kLanes);
        count = count_;
      }
      const Pack at_x = Pack::load_unaligned(px + j), at_y = Pack::load_unaligned(py + j),
                 at_z = Pack::load_unaligned(pz + j);
      const Pack x = Outside(at_x, box[0]), y = Outside(at_y, box[1]), z = Outside(at_z, box[2]);
      const std::uint64_t mask = LaneMask(rules_.Felt({x, y, z})) & (Bit(last - j) - 1);
      StoreSetLanes(mask, at_x, block_[0] + count);
      StoreSetLanes(mask, at_y, block_[1] + count);
      StoreSetLanes(mask, at_z, block_[2] + count);
      StoreSetLanes(mask, Pack::load_unaligned(vx + j), block_[3] + count);
      StoreSetLanes(mask, Pack::load_unaligned(vy + j), block_[4] + count);
      StoreSetLanes(mask, Pack::load_unaligned(vz + j), block_[5] + count);
      count += static_cast<std::uint32_t>(__builtin_popcountll(mask));
    }
    count_ = count;
  }
  void AppendOne(std::uint32_t j) {
    for (int k = 0; k < 6; ++k) block_[k][count_] = Column(k)[j];
    if (j - tile_.first < Size()) animals_[j - tile_.first].self = count_;
    ++count_;
  }
  void AppendOwn() {
    MakeRoom(kLanes);
    for (std::uint32_t j = tile_.first; j < tile_.last; ++j) AppendOne(j);
  }
  // Those of [first, last) that the row samples, wherever they are.
  void AppendSample(const RowSample& sample, std::uint32_t first, std::uint32_t last) {
    ForEachSampled(sample, first, last, [this](std::uint32_t j) {
      MakeRoom(1);
      AppendOne(j);
    });
  }

  void Collect() {
    const Interval box[3] = {Bounds(job_.x, tile_.first, tile_.last),
                             Bounds(job_.y, tile_.first, tile_.last),
                             Bounds(job_.z, tile_.first, tile_.last)};
    const RowSample sample = job_.sample != nullptr ? job_.sample[tile_.row] : RowSample{1, 0};
    ForEachRun(job_, tile_, box[0], [&](std::uint32_t first, std::uint32_t last, bool own_row) {
      if (sample.stride > 1) {
        AppendSample(sample, first, last);
      } else if (own_row) {
        AppendNear(first, tile_.first, box);
        AppendOwn();
        AppendNear(tile_.last, last, box);
      } else {
        AppendNear(first, last, box);
      }
    });
  }

  // ---- sums -------------------------------------------------------------------------------------

  // Lists what is left of the last block and the animals of this one that are within reach.
  void Sift(std::uint32_t at, std::uint32_t begin, Animal* animal) {
    const Pack x(job_.x[at]), y(job_.y[at]), z(job_.z[at]);
    if (!fresh_) {
      for (int k = 0; k < 6; ++k) Copy(animal->left[k], near_[k] + begin);
    }
    std::uint32_t end = begin + animal->left_count;
    const std::uint32_t self = animal->self, count = count_;
    for (std::uint32_t q = 0; q < count; q += kLanes) {
      const Pack dx = Pack::load_aligned(block_[0] + q) - x,
                 dy = Pack::load_aligned(block_[1] + q) - y,
                 dz = Pack::load_aligned(block_[2] + q) - z;
      const std::uint64_t mask = LaneMask(rules_.Felt({dx, dy, dz})) & ~Bit(self - q);
      StoreSetLanes(mask, dx, near_[0] + end);
      StoreSetLanes(mask, dy, near_[1] + end);
      StoreSetLanes(mask, dz, near_[2] + end);
      for (int k = 3; k < 6; ++k) {
        StoreSetLanes(mask, Pack::load_aligned(block_[k] + q), near_[k] + end);
      }
      end += static_cast<std::uint32_t>(__builtin_popcountll(mask));
    }
    animal->begin = begin;
    animal->end = end;
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

  void SumBlock(bool last) {
    for (std::uint32_t q = count_; q < count_ + kEight; ++q) block_[0][q] = __builtin_nanf("");
    std::uint32_t begin = 0;
    for (std::uint32_t a = 0; a < Size(); ++a) {
      Sift(tile_.first + a, begin, &animals_[a]);
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

  // Eight sums to one: k and k + 4, then k and k + 2, then both. For four animals from a on.
  void Fold(std::uint32_t a, std::uint32_t row, float* four) const {
    const auto halves = [&](std::uint32_t animal) {
      const float* const sums = animals_[a + animal].sums[row];
      return _mm_add_ps(_mm_load_ps(sums), _mm_load_ps(sums + 4));
    };
    const auto quarters = [&](std::uint32_t animal) {
      const __m128 f = halves(animal), g = halves(animal + 1);
      return _mm_add_ps(_mm_movelh_ps(f, g), _mm_movehl_ps(g, f));
    };
    const __m128 u = quarters(0), v = quarters(2);
    _mm_store_ps(four, _mm_add_ps(_mm_shuffle_ps(u, v, 0x88), _mm_shuffle_ps(u, v, 0xDD)));
  }

  void Finish() {
    alignas(64) float total[kRows][kLanes], counts[4][kLanes];
    for (std::uint32_t a = 0; a < kLanes; a += 4) {
      for (std::uint32_t row = 0; row < kRows; ++row) Fold(a, row, total[row] + a);
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
  bool fresh_ = true;                                               // nothing has been summed yet
  std::uint32_t count_ = 0;                                         // animals in the block
  alignas(64) float block_[6][kBlock + 2 * kEight];                 // x, y, z, vx, vy, vz
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
