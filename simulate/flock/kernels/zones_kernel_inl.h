// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Three zones with hard edges (simulate/flock/zone_pairs.h); included once by each variant, as
// near_block_inl.h.
//
// A tile's animals are taken one after the other: of its candidates less than a quarter are
// neighbours of any one of them. Those in the zone of attraction, which are most, are told by their
// distance alone; they are listed by themselves, with nothing but dx, and need neither masks nor
// velocities. The n-th of either list, in the order of the sort, is added to sum n % 8 of eight;
// pair_forces.cc does the same without packs. Of a block all animals' neighbours are listed first
// and summed afterwards: what was just stored in small pieces is slow to load.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_ZONES_KERNEL_INL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_ZONES_KERNEL_INL_H_

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <xsimd/xsimd.hpp>

#include "simulate/flock/kernels/kernels.h"
#include "simulate/flock/kernels/near_block_inl.h"
#include "simulate/flock/kernels/pair_kernel_inl.h"
#include "simulate/flock/kernels/set_bits_inl.h"
#include "simulate/flock/zone_pairs.h"

namespace flocklift {
namespace {

template <typename Pack>
class ZonesTile {
 public:
  using Rules = ZonePairs<Pack, HardEdge>;

  ZonesTile(const PairJob& job, const Rules& rules) : job_(job), rules_(rules) {
    for (Animal& animal : animals_) Clear(&animal);  // a tile may be smaller than a pack
  }

  void Sum(const TileOf& tile) {
    tile_ = tile;
    fresh_ = true;
    for (std::uint32_t a = 0; a < Size(); ++a) Clear(&animals_[a]);
    block_.Collect(
        job_, tile, [this](const Vec3<Pack>& dx) { return rules_.Felt(dx); },
        [this](bool last) { SumBlock(last); });
    Finish();
  }

 private:
  static constexpr std::uint32_t kLanes = Pack::size, kParts = kEight / kLanes;
  static constexpr std::uint32_t kRoom = 192, kColumn = NearBlock<Pack, kRoom>::kColumn;
  static constexpr std::uint32_t kListRoom = kLanes * (kRoom + kEight) + kEight;
  static_assert(kRoom + kEight <= 256, "places fit in a byte");
  static constexpr std::uint32_t kRows = 9;  // of sums
  static constexpr std::uint32_t kRepulsion = 0, kAlignment = 3, kAttraction = 6;

  struct Animal {
    alignas(32) float sums[kRows][kEight];
    float left[9][kEight];  // of both lists, too few for a pack, for the next block
    std::uint32_t left_far, left_close;
    std::uint32_t far, far_end, close, close_end;  // in the lists
    std::uint32_t counts[3];                       // neighbours that repel, align, attract
  };

  std::uint32_t Size() const { return tile_.last - tile_.first; }

  static void Clear(Animal* animal) {
    const Pack zero(0.0f);
    for (auto& row : animal->sums) {
      for (std::uint32_t part = 0; part < kEight; part += kLanes) zero.store_aligned(row + part);
    }
    animal->left_far = animal->left_close = 0;
    for (std::uint32_t& count : animal->counts) count = 0;
  }

  // The steps are functions of their own: inlined into one another they run out of registers.

  // Lists the animals of the block that are within reach, from numbers `far` and `close` on.
  [[gnu::noinline]] void Sift(std::uint32_t a, std::uint32_t far_begin, std::uint32_t close_begin) {
    Animal& animal = animals_[a];
    const std::uint32_t at = tile_.first + a, count = block_.count();
    const Pack x(job_.x[at]), y(job_.y[at]), z(job_.z[at]);
    const Pack r_ali = rules_.alignment.r_ali, close_squared = r_ali * r_ali;
    const Pack r_att = rules_.attraction.r_att, far_squared = r_att * r_att;
    if (!fresh_) {
      for (std::uint32_t k = 0; k < 3; ++k) Copy(animal.left[k], far_[k] + far_begin);
      std::memset(places_ + close_begin, 0, animal.left_close);
    }
    const float* const from = block_.columns();
    float* const to = far_[0];
    std::size_t far = far_begin + animal.left_far, close = close_begin + animal.left_close;
    const std::size_t before = far;
    std::uint64_t base = 0;  // in every byte the number of the pack's first
    for (std::size_t q = 0; q < count; q += kLanes) {
      const Vec3<Pack> dx{Pack::load_aligned(from + q) - x,
                          Pack::load_aligned(from + kColumn + q) - y,
                          Pack::load_aligned(from + 2 * kColumn + q) - z};
      const Pack squared = Dot(dx, dx);
      const std::uint64_t others = block_.Others(a, q);
      const std::uint64_t closes = LaneMask(squared < close_squared) & others;
      const std::uint64_t attracts = LaneMask(squared <= far_squared) & others & ~closes;
      const std::uint64_t numbers = kSetBits.of[closes] + base;
      base += kLanes * 0x0101010101010101U;
      std::memcpy(places_ + close, &numbers, sizeof(numbers));
      close += static_cast<std::size_t>(__builtin_popcountll(closes));
      StoreSetLanes(attracts, dx.x, to + far);
      StoreSetLanes(attracts, dx.y, to + kListRoom + far);
      StoreSetLanes(attracts, dx.z, to + 2 * kListRoom + far);
      far += static_cast<std::size_t>(__builtin_popcountll(attracts));
    }
    animal.counts[2] += static_cast<std::uint32_t>(far - before);
    animal.far = far_begin;
    animal.far_end = static_cast<std::uint32_t>(far);
    animal.close = close_begin;
    animal.close_end = static_cast<std::uint32_t>(close);
  }

  // Writes out the list of all that are close to any animal.
  [[gnu::noinline]] void Fetch() {
    const float *const x = job_.x, *const y = job_.y, *const z = job_.z;
    const float *const vx = job_.vx, *const vy = job_.vy, *const vz = job_.vz;
    const std::uint32_t* const numbers = block_.numbers();
    const std::size_t end = animals_[Size() - 1].close_end;
    for (std::size_t n = 0; n < end; ++n) {
      const std::uint32_t j = numbers[places_[n]];
      close_[0][n] = x[j];
      close_[1][n] = y[j];
      close_[2][n] = z[j];
      close_[3][n] = vx[j];
      close_[4][n] = vy[j];
      close_[5][n] = vz[j];
    }
    if (fresh_) return;
    for (std::uint32_t a = 0; a < Size(); ++a) {
      for (std::uint32_t k = 0; k < 6; ++k) {
        for (std::uint32_t n = 0; n < animals_[a].left_close; ++n) {
          close_[k][animals_[a].close + n] = animals_[a].left[3 + k][n];
        }
      }
    }
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

  // Which lanes of a pack that begins at number n hold one of `count`.
  static auto Filled(std::uint32_t n, std::uint32_t count) {
    alignas(64) float numbers[kLanes];
    for (std::uint32_t k = 0; k < kLanes; ++k) numbers[k] = static_cast<float>(k);
    return Pack::load_aligned(numbers) < Pack(static_cast<float>(static_cast<int>(count - n)));
  }

  // Adds `count` of a list.
  [[gnu::noinline]] void AddFar(std::uint32_t count, Animal* animal) const {
    for (std::uint32_t part = 0; part < kParts; ++part) {
      Vec3<Pack> attraction = LoadSums(*animal, kAttraction, part);
      for (std::uint32_t n = part * kLanes; n < count; n += kEight) {
        const auto load = [&](int k) { return Pack::load_unaligned(far_[k] + animal->far + n); };
        const Vec3<Pack> dx{load(0), load(1), load(2)};
        attraction += Kept(Filled(n, count), InverseLength(Dot(dx, dx)) * dx);
      }
      StoreSums(attraction, kAttraction, part, animal);
    }
  }
  [[gnu::noinline]] void AddClose(std::uint32_t at, std::uint32_t count, Animal* animal) const {
    const Vec3<Pack> x{Pack(job_.x[at]), Pack(job_.y[at]), Pack(job_.z[at])};
    const Vec3<Pack> v{Pack(job_.vx[at]), Pack(job_.vy[at]), Pack(job_.vz[at])};
    const Pack r_rep = rules_.repulsion.r_rep;
    std::uint32_t repel = 0;
    for (std::uint32_t part = 0; part < kParts; ++part) {
      Vec3<Pack> repulsion = LoadSums(*animal, kRepulsion, part);
      Vec3<Pack> alignment = LoadSums(*animal, kAlignment, part);
      for (std::uint32_t n = part * kLanes; n < count; n += kEight) {
        const auto load = [&](int k) {
          return Pack::load_unaligned(close_[k] + animal->close + n);
        };
        const Vec3<Pack> dx = Vec3<Pack>{load(0), load(1), load(2)} - x;
        const Vec3<Pack> dv = Vec3<Pack>{load(3), load(4), load(5)} - v;
        const Vec3<Pack> direction = ZoneDirection(rules_.repulsion, dx, dv);
        const auto filled = Filled(n, count);
        const auto repels = (Dot(dx, dx) < r_rep * r_rep) & filled;
        repulsion += Kept(repels, direction);
        alignment += Kept(repels ^ filled, direction);
        repel += static_cast<std::uint32_t>(__builtin_popcountll(LaneMask(repels)));
      }
      StoreSums(repulsion, kRepulsion, part, animal);
      StoreSums(alignment, kAlignment, part, animal);
    }
    animal->counts[0] += repel;
    animal->counts[1] += count - repel;
  }
  template <typename Mask>
  static Vec3<Pack> Kept(const Mask& mask, const Vec3<Pack>& v) {
    return {Where(mask, v.x), Where(mask, v.y), Where(mask, v.z)};
  }

  // Whole packs; at the end of the tile all that is left.
  [[gnu::noinline]] void SumBlock(bool last) {
    std::uint32_t far = 0, close = 0;
    for (std::uint32_t a = 0; a < Size(); ++a) {
      Sift(a, far, close);
      far = animals_[a].far_end;
      close = animals_[a].close_end;
    }
    Fetch();
    for (std::uint32_t a = 0; a < Size(); ++a) {
      Animal& animal = animals_[a];
      far = animal.far_end - animal.far;
      close = animal.close_end - animal.close;
      animal.left_far = last ? 0 : far % kEight;
      animal.left_close = last ? 0 : close % kEight;
      AddFar(far - animal.left_far, &animal);
      AddClose(tile_.first + a, close - animal.left_close, &animal);
      if (last) continue;
      for (std::uint32_t k = 0; k < 3; ++k) {
        Copy(far_[k] + animal.far_end - animal.left_far, animal.left[k]);
      }
      for (std::uint32_t k = 0; k < 6; ++k) {
        Copy(close_[k] + animal.close_end - animal.left_close, animal.left[3 + k]);
      }
    }
    fresh_ = false;
  }

  void Finish() {
    alignas(64) float total[kRows][kLanes], counts[3][kLanes];
    for (std::uint32_t a = 0; a < kLanes; a += 4) {
      for (std::uint32_t row = 0; row < kRows; ++row) {
        Fold(animals_[a].sums[row], sizeof(Animal) / sizeof(float), total[row] + a);
      }
      for (std::uint32_t k = a; k < a + 4; ++k) {
        for (int n = 0; n < 3; ++n) counts[n][k] = static_cast<float>(animals_[k].counts[n]);
      }
    }
    const auto sum = [&](std::uint32_t row, int n) -> Weighted<Pack> {
      return {{Pack::load_aligned(total[row]), Pack::load_aligned(total[row + 1]),
               Pack::load_aligned(total[row + 2])},
              Pack::load_aligned(counts[n])};
    };
    const typename Rules::Sums sums{sum(kRepulsion, 0), sum(kAlignment, 1), sum(kAttraction, 2)};
    const Vec3<Pack> acceleration = rules_.Finish(sums);
    Store(acceleration.x, tile_, job_.sums.ax);
    Store(acceleration.y, tile_, job_.sums.ay);
    Store(acceleration.z, tile_, job_.sums.az);
    Store(sums.Neighbours(), tile_, job_.sums.neighbours);
  }

  const PairJob& job_;
  const Rules rules_;
  TileOf tile_{};
  bool fresh_ = true;                              // nothing of the tile has been summed yet
  std::uint8_t places_[kListRoom];                 // in the block: who is close, by animal
  float far_[3][kListRoom], close_[6][kListRoom];  // dx; positions and velocities; by animal
  NearBlock<Pack, kRoom> block_;
  Animal animals_[kLanes];
};

template <typename Pack, typename Taper>
[[gnu::always_inline]] inline ZonePairs<Pack, Taper> ZoneRules(const ZonesJob& job, Taper taper) {
  const auto zone = [&](float gain) -> ZoneParams<Pack, Taper> {
    return {Pack(gain), Pack(job.r_rep), Pack(job.r_ali), Pack(job.r_att), taper};
  };
  return {zone(job.w_rep), zone(job.w_ali), zone(job.w_att)};
}

template <typename Pack>
[[gnu::noinline, gnu::flatten]] void SumZonesByAnimal(const ZonesJob& job, std::uint32_t first,
                                                      std::uint32_t last) {
  ZonesTile<Pack> sums(job.pairs, ZoneRules<Pack>(job, HardEdge{}));
  ForEachTile<Pack>(job.pairs, first, last, [&](const TileOf& tile) { sums.Sum(tile); });
}

}  // namespace
}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_ZONES_KERNEL_INL_H_
