// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The body of every variant of the swarm kernel; included once by each, after it has defined
//   void LerpCorners(const int8_t* cell, float u, float v, float w, float* four)
//   void Columns(const float* rows, batch* columns)   four columns of a pack of rows of four
//   void Prefetch(const void*)
//   batch<uint32_t> Gather(const uint8_t* from, batch<uint32_t> at)   four bytes from from + at on
// the first blends the numbers of a cell's corners: along z, then y, then x, each a + t (b - a).
// Everything lives in an anonymous namespace (boids_kernel.h says why).

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SWARM_KERNEL_INL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SWARM_KERNEL_INL_H_

#include <cstddef>
#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "simulate/fields/curl_noise.h"
#include "simulate/flock/kernels/lattice_pack.h"
#include "simulate/flock/kernels/swarm_kernel.h"

namespace flocklift {
namespace {

// As many animals as are looked up ahead of being used.
inline constexpr std::uint32_t kAhead = 64;

// Where in the guide some animals are.
struct GuidePlaces {
  alignas(64) const std::int8_t* cell[kAhead];
  alignas(64) float share[3][kAhead];  // of the way through the cell
};

// A cell's number along one axis.
template <typename Pack>
Pack PlaceAlong(const Pack& x, float low, float per_spacing, int cells, float* share) {
  const Pack u = xsimd::min(xsimd::max(Pack(0.0f), (x - Pack(low)) * Pack(per_spacing)),
                            Pack(static_cast<float>(cells)));
  const Pack cell = xsimd::min(xsimd::floor(u), Pack(static_cast<float>(cells - 1)));
  (u - cell).store_aligned(share);
  return cell;
}

template <typename Pack>
void FindPlaces(const SwarmJob& job, std::uint32_t first, std::uint32_t last, GuidePlaces* places) {
  const SwarmGuide& g = job.guide;
  using Bits = typename Lattice<Pack>::Bits;
  const Bits nx(static_cast<std::uint32_t>(g.nx)), ny(static_cast<std::uint32_t>(g.ny));
  for (std::uint32_t k = first; k < last; k += Pack::size) {
    const std::uint32_t at = k - first;
    const auto whole = [](const Pack& cell) { return Lattice<Pack>::Cell(cell); };
    const Bits i = whole(PlaceAlong(Pack::load_unaligned(job.x + k), g.low_x, g.per_spacing, g.nx,
                                    places->share[0] + at));
    const Bits j = whole(PlaceAlong(Pack::load_unaligned(job.y + k), g.low_y, g.per_spacing, g.ny,
                                    places->share[1] + at));
    const Bits l = whole(PlaceAlong(Pack::load_unaligned(job.z + k), g.low_z, g.per_spacing, g.nz,
                                    places->share[2] + at));
    alignas(64) std::uint32_t number[Pack::size];
    ((l * ny + j) * nx + i).store_aligned(number);
    for (std::size_t lane = 0; lane < Pack::size; ++lane) {
      const std::int8_t* const cell = g.cells + std::size_t{kGuideCellBytes} * number[lane];
      places->cell[at + lane] = cell;
      Prefetch(cell);
    }
  }
}

// Adds the guide's velocity to that of a pack, animal `at` of the places and following.
template <typename Pack>
Pack AddGuide(const SwarmGuide& guide, const GuidePlaces& places, std::uint32_t at, Vec3<Pack>* v) {
  alignas(64) float found[4 * Pack::size];
  for (std::size_t lane = 0; lane < Pack::size; ++lane) {
    const std::size_t k = at + lane;
    LerpCorners(places.cell[k], places.share[0][k], places.share[1][k], places.share[2][k],
                found + 4 * lane);
  }
  Pack columns[4];
  Columns(found, columns);
  const Pack speed(guide.speed / 127.0f), reach(guide.reach / 127.0f);
  v->x += columns[0] * speed;
  v->y += columns[1] * speed;
  v->z += columns[2] * speed;
  return columns[3] * reach;
}

template <typename Pack>
Vec3<Pack> AddNoise(const SwarmJob& job, const Vec3<Pack>& x) {
  Vec3<Pack> v{Pack(0.0f), Pack(0.0f), Pack(0.0f)};
  for (int n = 0; n < job.noise_count; ++n) {
    const SwarmNoise& noise = job.noise[n];
    const NoiseTerm<Pack> term{Pack(noise.gain), Pack(noise.scale), noise.seed};
    v += job.curl ? CurlNoise(term, x) : PerlinVelocity(term, x);
  }
  return v;
}

template <typename Pack>
void SwarmVelocities(const SwarmJob& job, std::uint32_t first, std::uint32_t last) {
  GuidePlaces places;
  for (std::uint32_t begin = first; begin < last; begin += kAhead) {
    const std::uint32_t end = last - begin < kAhead ? last : begin + kAhead;
    if (job.guide.cells != nullptr) FindPlaces<Pack>(job, begin, end, &places);
    for (std::uint32_t k = begin; k < end; k += Pack::size) {
      Vec3<Pack> v =
          AddNoise<Pack>(job, {Pack::load_unaligned(job.x + k), Pack::load_unaligned(job.y + k),
                               Pack::load_unaligned(job.z + k)});
      if (job.guide.cells != nullptr) {
        AddGuide(job.guide, places, k - begin, &v).store_unaligned(job.distance + k);
      }
      v.x.store_unaligned(job.vx + k);
      v.y.store_unaligned(job.vy + k);
      v.z.store_unaligned(job.vz + k);
    }
  }
}

template <typename Pack>
typename Lattice<Pack>::Bits CellNumber(const CellJob& job, std::uint32_t k) {
  using Lane = Lattice<Pack>;
  const Pack per_cell(job.per_cell), shift(job.shift), far(1073741824.0f);
  const auto cell = [&](const float* at) {  // beyond `far` all are in one
    const Pack u = xsimd::floor(Pack::load_unaligned(at) * per_cell - shift);
    return Lane::Cell(xsimd::min(far, xsimd::max(Pack(-1073741824.0f), u)));
  };
  return cell(job.x + k) + cell(job.y + k) * typename Lane::Bits(job.across_y) +
         cell(job.z + k) * typename Lane::Bits(job.across_z);
}

template <typename Pack>
void CellNumbers(const CellJob& job, std::uint32_t first, std::uint32_t last) {
  for (std::uint32_t k = first; k < last; k += Pack::size) {
    CellNumber<Pack>(job, k).store_unaligned(job.cell + k);
  }
}

template <typename Pack>
std::uint32_t FindCompany(const CompanyJob& job, std::uint32_t first, std::uint32_t last,
                          std::uint32_t* found, std::uint32_t* lowest) {
  using Bits = typename Lattice<Pack>::Bits;
  const Bits one(1U), seven(7U), three(3U), mask(job.mask);
  std::uint32_t count = 0;
  for (std::uint32_t k = first; k < last; k += Pack::size) {
    const Bits at = CellNumber<Pack>(job.cells, k);
    const auto two = [&](std::uint32_t across) -> Bits {  // neighbours along x
      const Bits bit = (at + Bits(across)) & mask;
      return (Gather(job.bits, bit >> 3) >> (bit & seven)) & three;
    };
    const std::uint32_t y = job.cells.across_y, z = job.cells.across_z;
    const Bits eight = two(0) | two(y) << 2 | two(z) << 4 | two(y + z) << 6;
    const Bits further = eight & (eight - one);  // bits but the lowest
    // Without a branch, so that bits that another core has set are waited for all at once.
    alignas(64) std::uint32_t has[Pack::size], numbers[Pack::size];
    further.store_aligned(has);
    at.store_aligned(numbers);
    for (std::uint32_t lane = 0; lane < Pack::size; ++lane) {
      found[count] = k + lane;
      lowest[count] = numbers[lane];
      count += has[lane] != 0 ? 1 : 0;
    }
  }
  return count;
}

// Whom those at some places of a sort are nearer to than the sum of their rooms; lanes hold others.
template <typename Pack>
struct TooNear {
  static constexpr auto kLanes = static_cast<std::uint32_t>(Pack::size);
  const float *x, *y, *z, *room;
  Pack lanes;

  TooNear(const float* xs, const float* ys, const float* zs, const float* rooms)
      : x(xs), y(ys), z(zs), room(rooms) {
    alignas(64) float numbers[kLanes];
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) numbers[lane] = static_cast<float>(lane);
    lanes = Pack::load_aligned(numbers);
  }
  // A lane each for `begin` and those that follow, false from `end` on.
  [[gnu::always_inline]] auto operator()(std::uint32_t k, std::uint32_t begin,
                                         std::uint32_t end) const {
    const Pack dx = Pack::load_unaligned(x + begin) - Pack(x[k]),
               dy = Pack::load_unaligned(y + begin) - Pack(y[k]),
               dz = Pack::load_unaligned(z + begin) - Pack(z[k]);
    const Pack squared = dx * dx + dy * dy + dz * dz;
    const Pack distance = Pack(room[k]) + Pack::load_unaligned(room + begin);
    const auto count = static_cast<std::int32_t>(end - begin);  // below 0: nobody
    return (squared < distance * distance) & (lanes < Pack(static_cast<float>(count)));
  }
};

template <typename Pack>
std::uint32_t FindNear(const NearJob& job, std::uint32_t first, std::uint32_t last,
                       std::uint32_t* found) {
  constexpr auto kLanes = static_cast<std::uint32_t>(Pack::size);
  const TooNear<Pack> too_near(job.x, job.y, job.z, job.room);
  std::uint32_t count = 0;
  for (std::uint32_t k = first; k < last; ++k) {
    const auto near = [&](std::uint32_t begin, std::uint32_t end) {
      return too_near(k, begin, end);
    };
    const bool at_rim = (job.cell[k] & kNearAtRim) != 0;
    const std::uint32_t* const start = job.start + (job.cell[k] & ~kNearAtRim);
    auto any = near(k + 1, start[2]);
    for (std::uint32_t a = k + 1 + kLanes; a < start[2]; a += kLanes) any = any | near(a, start[2]);
    if (at_rim) {
      std::uint32_t begin[4], end[4], longest = 0;
      for (int row = 0; row < 4; ++row) {  // without branches: most runs are short, many empty
        begin[row] = *(start + job.row[row] - 1);
        end[row] = *(start + job.row[row] + 2);
        const std::uint32_t length = end[row] - begin[row];
        longest = longest > length ? longest : length;
        any = any | near(begin[row], end[row]);
      }
      for (std::uint32_t done = kLanes; done < longest; done += kLanes) {
        for (int row = 0; row < 4; ++row) {
          if (end[row] - begin[row] > done) any = any | near(begin[row] + done, end[row]);
        }
      }
    }
    found[count] = k;
    count += xsimd::any(any) ? 1 : 0;
  }
  return count;
}

template <typename Pack>
std::uint32_t FindClose(const CloseJob& job, std::uint32_t first, std::uint32_t last,
                        std::uint32_t* found) {
  constexpr auto kLanes = static_cast<std::uint32_t>(Pack::size);
  const TooNear<Pack> too_near(job.x, job.y, job.z, job.room);
  const std::uint32_t across[4] = {0, job.across_y, job.across_z, job.across_y + job.across_z};
  std::uint32_t count = 0;
  for (std::uint32_t k = first; k < last; ++k) {
    std::uint32_t begin[4], end[4];
    std::int32_t longest = 0;
    xsimd::batch_bool<float, typename Pack::arch_type> any(false);
    for (int row = 0; row < 4; ++row) {  // without branches: most runs are short, many empty
      const std::uint32_t bucket = (job.lowest[k] + across[row]) & job.mask;
      begin[row] = job.start[bucket] > k ? job.start[bucket] : k + 1;
      end[row] = job.start[bucket + 2];
      const auto length = static_cast<std::int32_t>(end[row] - begin[row]);
      longest = longest > length ? longest : length;
      any = any | too_near(k, begin[row], end[row]);
      if (bucket == job.mask) {  // the second is the first of all
        for (std::uint32_t a = k + 1; a < job.start[1]; a += kLanes) {
          any = any | too_near(k, a, job.start[1]);
        }
      }
    }
    for (auto done = kLanes; static_cast<std::int32_t>(done) < longest; done += kLanes) {
      for (int row = 0; row < 4; ++row) {
        if (begin[row] + done < end[row]) any = any | too_near(k, begin[row] + done, end[row]);
      }
    }
    found[count] = k;
    count += xsimd::any(any) ? 1 : 0;
  }
  return count;
}

}  // namespace
}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SWARM_KERNEL_INL_H_
