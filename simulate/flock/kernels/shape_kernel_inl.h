// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The pairs of a shape-constrained swarm (simulate/flock/shape_pairs.h) from lists of neighbours
// (simulate/flock/near_lists.h); included once by each variant, after it has defined, besides what
// near_block_inl.h asks for,
//   Vec3<batch> FetchVectors(rows, places)   x, y, z of a pack of rows of 8 numbers, by number
//
// Animals are taken a group at a time: the neighbours of all are fetched and counted, gains follow
// from the counts, and shares are summed. Both loops run over the lists' units of eight, whoever's
// they are: a loop of its own for each animal, two units as a rule, would end in a wrong guess of
// the processor. Neighbour n of a list is added to sum n % 8 of eight; shape_sums.cc does the same
// without packs.

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
class ListedShapes {
 public:
  ListedShapes(const ShapeJob& job, const ShapePairs<Pack>& rules) : job_(job), rules_(rules) {}

  void Sum(std::uint32_t first, std::uint32_t last) {
    for (first_ = first; first_ < last; first_ += animals_) {
      animals_ = last - first_ < kGroup ? last - first_ : kGroup;
      const std::uint32_t* const begins = job_.begin + (first_ - first);
      const std::uint32_t begin = *begins;
      while (animals_ > 1 && begins[animals_] - begin > kGroupPlaces) animals_ = (animals_ + 1) / 2;
      Count(begin, begins[animals_]);
      SetGains();
      Add(begin, begins[animals_]);
      Finish();
    }
  }

 private:
  using ByTerm = typename ShapePairs<Pack>::ByTerm;
  static constexpr std::uint32_t kLanes = Pack::size, kParts = kEight / kLanes;
  static constexpr std::uint32_t kRow = 8, kVelocity = 4;      // numbers of a row; from there on
  static constexpr std::uint32_t kGroup = 32;                  // animals at most, as well as
  static constexpr std::uint32_t kGroupPlaces = 100 * kEight;  // or one: what is kept fits in L1
  static constexpr std::uint32_t kKept = 5 * kLanes;           // numbers of a Look

  Vec3<Pack> Own(std::uint32_t animal, std::uint32_t from) const {
    const float* const row = job_.rows + std::size_t{kRow} * animal + from;
    return {Pack(row[0]), Pack(row[1]), Pack(row[2])};
  }

  // The steps are functions of their own: inlined into one another they run out of registers.

  [[gnu::noinline]] void Count(std::uint32_t begin, std::uint32_t end) {
    for (auto& counts : counted_) counts = {};
    const ShapePairs<Pack> rules = rules_;
    float* kept = job_.looks;
    for (std::uint32_t n = begin; n < end; n += kLanes, kept += kKept) {
      const std::uint32_t owner = job_.owner[n / kEight];
      const auto look = rules.LookAt(FetchVectors(job_.rows, job_.places + n) - Own(owner, 0));
      look.direction.x.store_aligned(kept);
      look.direction.y.store_aligned(kept + kLanes);
      look.direction.z.store_aligned(kept + 2 * kLanes);
      look.squared.store_aligned(kept + 3 * kLanes);
      look.fall.store_aligned(kept + 4 * kLanes);
      const auto terms = rules.ZonesOf(look.squared, look.spreads);
      const auto count = [](const auto& mask) {
        return static_cast<std::uint32_t>(__builtin_popcountll(LaneMask(mask)));
      };
      Counted& counts = counted_[owner - first_];
      counts.repel += count(terms.repels);
      counts.align += count(terms.aligns);
      counts.attract += count(terms.attracts);
      counts.spread += count(terms.spreads);
    }
    for (std::uint32_t a = 0; a < kGroup; ++a) {
      counts_[0][a] = static_cast<float>(counted_[a].repel);
      counts_[1][a] = static_cast<float>(counted_[a].align);
      counts_[2][a] = static_cast<float>(counted_[a].attract);
      counts_[3][a] = static_cast<float>(counted_[a].spread);
    }
  }

  ByTerm Counts(std::uint32_t a) const {
    return {Pack::load_aligned(counts_[0] + a), Pack::load_aligned(counts_[1] + a),
            Pack::load_aligned(counts_[2] + a), Pack::load_aligned(counts_[3] + a)};
  }
  void SetGains() {
    for (std::uint32_t a = 0; a < kGroup; a += kLanes) {
      const ByTerm gains = rules_.Gains(Counts(a));
      gains.repel.store_aligned(gains_[0] + a);
      gains.align.store_aligned(gains_[1] + a);
      gains.attract.store_aligned(gains_[2] + a);
      gains.spread.store_aligned(gains_[3] + a);
    }
  }

  [[gnu::noinline]] void Add(std::uint32_t begin, std::uint32_t end) {
    for (auto& sums : sums_) {
      for (auto& axis : sums) {
        for (std::uint32_t part = 0; part < kEight; part += kLanes) {
          Pack(0.0f).store_aligned(axis + part);
        }
      }
    }
    const ShapePairs<Pack> rules = rules_;
    const float* kept = job_.looks;
    for (std::uint32_t n = begin; n < end; n += kEight) {
      const std::uint32_t owner = job_.owner[n / kEight], a = owner - first_;
      const Vec3<Pack> v = Own(owner, kVelocity);
      const ByTerm gains{Pack(gains_[0][a]), Pack(gains_[1][a]), Pack(gains_[2][a]),
                         Pack(gains_[3][a])};
      for (std::uint32_t part = 0; part < kEight; part += kLanes, kept += kKept) {
        const auto load = [kept](std::uint32_t k) { return Pack::load_aligned(kept + k * kLanes); };
        const Vec3<Pack> share =
            rules.Pair(gains, {load(0), load(1), load(2)}, load(3), load(4),
                       FetchVectors(job_.rows + kVelocity, job_.places + n + part) - v);
        const auto add = [part](const Pack& value, float* sum) {
          (Pack::load_aligned(sum + part) + value).store_aligned(sum + part);
        };
        add(share.x, sums_[a][0]);
        add(share.y, sums_[a][1]);
        add(share.z, sums_[a][2]);
      }
    }
  }

  void Finish() {
    alignas(64) float total[3][kLanes];
    for (std::uint32_t a = 0; a < animals_; a += kLanes) {
      for (std::uint32_t four = 0; four < kLanes; four += 4) {
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
          Fold(sums_[a + four][axis], 3 * kEight, total[axis] + four);
        }
      }
      const std::uint32_t end = a + kLanes < animals_ ? a + kLanes : animals_;
      const TileOf tile{first_ + a, first_ + end, 0};
      Store(Pack::load_aligned(total[0]), tile, job_.ax);
      Store(Pack::load_aligned(total[1]), tile, job_.ay);
      Store(Pack::load_aligned(total[2]), tile, job_.az);
      Store(rules_.Neighbours(Counts(a)), tile, job_.neighbours);
    }
  }

  struct Counted {
    std::uint32_t repel, align, attract, spread;
  };

  const ShapeJob& job_;
  const ShapePairs<Pack> rules_;
  std::uint32_t first_ = 0, animals_ = 0;  // of the group
  Counted counted_[kGroup] = {};
  alignas(64) float counts_[4][kGroup] = {};  // of animals, as of Counted
  alignas(64) float gains_[4][kGroup] = {};
  alignas(64) float sums_[kGroup][3][kEight] = {};
};

}  // namespace
}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SHAPE_KERNEL_INL_H_
