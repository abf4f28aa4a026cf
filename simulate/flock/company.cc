// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/company.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "simulate/flock/kernels/swarm_kernel.h"

namespace flocklift {
namespace {

constexpr double kCellPerReach = 2.1;  // twice, and round-off
constexpr std::size_t kBitsPerAnimal = 64;
constexpr std::uint32_t kLeastBits = 512;
constexpr double kWidest = 1e6;        // cells; a flock wider than that is numbered without order
constexpr std::size_t kMoreBytes = 8;  // the first again, and what kernels may read
constexpr std::uint32_t kHashY = 0x9E3779B1U, kHashZ = 0x85EBCA77U;  // odd

template <typename T>
double Extent(T low, T high) {
  return std::max(0.0, static_cast<double>(high) - static_cast<double>(low));
}

// The largest whole number below u. Far outside all animals are in one place; so is what is not a
// number.
template <typename T>
std::uint32_t Floor(T u) {
  const T far = T(1 << 30);
  const T kept = std::min(far, std::max(-far, u));
  const auto cut = static_cast<std::int32_t>(kept);
  return static_cast<std::uint32_t>(cut - (static_cast<T>(cut) > kept ? 1 : 0));
}

// fn(crowd, first, last, before) for pieces of at most kCrowdGrain animals; `before`, counted
// through all crowds, come before the crowd.
template <typename T, typename Function>
void ForEachPiece(std::span<const Crowd<T>> crowds, const Function& fn) {
  std::size_t before = 0;
  for (const Crowd<T>& crowd : crowds) {
    for (std::size_t k = 0; k < crowd.size; k += kCrowdGrain) {
      fn(crowd, k, std::min<std::size_t>(k + kCrowdGrain, crowd.size), before);
    }
    before += crowd.size;
  }
}

}  // namespace

template <typename T>
double Company<T>::Density(std::span<const Crowd<T>> crowds, const CrowdBox<T>& box, T reach) {
  double animals = 0, cells = 1;
  for (const Crowd<T>& crowd : crowds) animals += static_cast<double>(crowd.size);
  const double edge = kCellPerReach * static_cast<double>(reach);
  for (const double extent : {Extent(box.low.x, box.high.x), Extent(box.low.y, box.high.y),
                              Extent(box.low.z, box.high.z)}) {
    cells *= extent / edge + 1;
  }
  return animals / cells;
}

template <typename T>
std::uint32_t Company<T>::Cell(T x, T y, T z, T shift) const {
  return Floor(x * per_cell_ - shift) + Floor(y * per_cell_ - shift) * across_y_ +
         Floor(z * per_cell_ - shift) * across_z_;
}

template <typename T>
void Company<T>::Number(const Crowd<T>& crowd, std::size_t first, std::size_t last,
                        std::uint32_t* to) const {
  std::size_t k = first;
  if constexpr (std::is_same_v<T, float>) {
    const std::size_t whole = (last - first) / 8 * 8;
    FastestSwarmKernel().cells({crowd.x + first, crowd.y + first, crowd.z + first, per_cell_, T(0),
                                across_y_, across_z_, to},
                               0, static_cast<std::uint32_t>(whole));
    k += whole;
  }
  for (; k < last; ++k) to[k - first] = Cell(crowd.x[k], crowd.y[k], crowd.z[k]);
}

template <typename T>
void Company<T>::NumberLattice(const CrowdBox<T>& box, T reach, std::size_t animals) {
  const double edge = kCellPerReach * static_cast<double>(reach);
  const auto cells = [edge](T low, T high) { return std::floor(Extent(low, high) / edge) + 3; };
  const double nx = cells(box.low.x, box.high.x), ny = cells(box.low.y, box.high.y),
               nz = cells(box.low.z, box.high.z);
  std::size_t bits = kBitsPerAnimal * animals;
  if (nx < kWidest && ny < kWidest && nz < kWidest) {
    across_y_ = static_cast<std::uint32_t>(nx);
    across_z_ = across_y_ * static_cast<std::uint32_t>(ny);
    if (nx * ny * nz < static_cast<double>(bits)) bits = static_cast<std::size_t>(nx * ny * nz);
  } else {
    across_y_ = kHashY;
    across_z_ = kHashZ;
  }
  per_cell_ = static_cast<T>(1 / edge);
  mask_ = static_cast<std::uint32_t>(std::bit_ceil(std::max<std::size_t>(bits, kLeastBits))) - 1;
}

template <typename T>
void Company<T>::SetBits(std::span<const Crowd<T>> crowds) {
  bits_.assign((static_cast<std::size_t>(mask_) + 1) / 8 + kMoreBytes, 0);
  shared_.clear();
  std::uint8_t* const bits = bits_.data();
  ForEachPiece(crowds, [&](const Crowd<T>& crowd, std::size_t begin, std::size_t end, std::size_t) {
    std::uint32_t cell[kCrowdGrain];
    Number(crowd, begin, end, cell);
    for (std::size_t n = 0; n < end - begin; ++n) {
      const std::uint32_t bit = cell[n] & mask_;
      const unsigned had = bits[bit / 8], one = 1U << bit % 8;
      bits[bit / 8] = static_cast<std::uint8_t>(had | one);
      if ((had & one) != 0) shared_.push_back(bit);
    }
  });
}

template <typename T>
void Company<T>::SetNeighbours() {
  for (const std::uint32_t bit : shared_) {
    for (const std::uint32_t next : {(bit - 1) & mask_, (bit + 1) & mask_}) {
      bits_[next / 8] |= static_cast<std::uint8_t>(1U << next % 8);
    }
  }
  bits_[(static_cast<std::size_t>(mask_) + 1) / 8] = bits_[0];
}

// Those that see a second bit.
template <typename T>
void Company<T>::LookUp(std::span<const Crowd<T>> crowds) {
  const std::uint8_t* const bits = bits_.data();
  const auto bit = [&](std::uint32_t cell) {
    const std::uint32_t at = cell & mask_;
    return bits[at / 8] >> at % 8 & 1;
  };
  found_.clear();
  ForEachPiece(
      crowds, [&](const Crowd<T>& crowd, std::size_t begin, std::size_t end, std::size_t before) {
        std::uint32_t company[kCrowdGrain], lowest[kCrowdGrain];
        std::uint32_t count = 0;
        std::size_t k = begin;
        if constexpr (std::is_same_v<T, float>) {
          const auto whole = static_cast<std::uint32_t>((end - begin) / 8 * 8);
          const CompanyJob job{{crowd.x + begin, crowd.y + begin, crowd.z + begin, per_cell_,
                                T(0.5), across_y_, across_z_, nullptr},
                               bits,
                               mask_};
          count = FastestSwarmKernel().company(job, 0, whole, company, lowest);
          k += whole;
        }
        for (; k < end; ++k) {
          const std::uint32_t at = Cell(crowd.x[k], crowd.y[k], crowd.z[k], T(0.5));
          int seen = 0;
          for (const std::uint32_t across : {0U, across_y_, across_z_, across_y_ + across_z_}) {
            seen += bit(at + across) + bit(at + across + 1);
          }
          company[count] = static_cast<std::uint32_t>(k - begin);
          lowest[count] = at;
          count += seen > 1 ? 1 : 0;
        }
        for (std::uint32_t n = 0; n < count; ++n) {
          const std::size_t at = begin + company[n];
          const T x = crowd.x[at], y = crowd.y[at], z = crowd.z[at];
          found_.push_back({static_cast<std::uint32_t>(before + at), Cell(x, y, z), lowest[n], x, y,
                            z, crowd.RoomOf(at)});
        }
      });
}

template <typename T>
void Company<T>::Find(std::span<const Crowd<T>> crowds, const CrowdBox<T>& box, T reach) {
  std::size_t total = 0;
  for (const Crowd<T>& crowd : crowds) total += crowd.size;
  NumberLattice(box, reach, total);
  SetBits(crowds);
  SetNeighbours();
  LookUp(crowds);
}

template class Company<float>;
template class Company<double>;

}  // namespace flocklift
