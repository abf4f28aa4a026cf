// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/company.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>

#include "simulate/flock/kernels/swarm_kernel.h"

namespace flocklift {
namespace {

constexpr double kCellPerReach = 2.1;  // twice, and round-off
constexpr std::size_t kBitsPerAnimal = 64;
constexpr std::uint32_t kLeastBits = 512;
constexpr double kWidest = 1e6;  // cells; a flock wider than that is numbered without order
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
void Company<T>::Number(const Crowd<T>& crowd, std::int64_t first, std::int64_t last,
                        std::uint32_t* to) const {
  std::int64_t k = first;
  if constexpr (std::is_same_v<T, float>) {
    k += (last - first) / 8 * 8;
    FastestSwarmKernel().cells(
        {crowd.x, crowd.y, crowd.z, per_cell_, T(0), across_y_, across_z_, to},
        static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(k));
  }
  for (; k < last; ++k) to[k] = Cell(crowd.x[k], crowd.y[k], crowd.z[k]);
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
void Company<T>::SetBits(ThreadPool* pool) {
  const std::uint32_t size = mask_ + 1;
  bits_.resize(size / 8 + 4);
  // Every thread looks at all animals and sets the bits of its part.
  const std::uint32_t parts = std::min(64U, std::bit_floor(static_cast<unsigned>(pool->threads())));
  const int shift = std::countr_zero(size / parts);
  shared_.resize(parts);
  pool->For(0, parts, 1, [&](std::int64_t part, std::int64_t) {
    std::uint8_t* const bits = bits_.data();
    std::vector<std::uint32_t>& shared = shared_[static_cast<std::size_t>(part)];
    shared.clear();
    std::fill_n(bits + (part << shift) / 8, size / parts / 8, std::uint8_t{0});
    for (const std::uint32_t cell : cell_) {
      const std::uint32_t bit = cell & (size - 1);
      if (parts > 1 && bit >> shift != static_cast<std::uint32_t>(part)) continue;
      const unsigned before = bits[bit / 8], one = 1U << bit % 8;
      bits[bit / 8] = static_cast<std::uint8_t>(before | one);
      if ((before & one) != 0) shared.push_back(bit);
    }
  });
  for (const auto& shared : shared_) {
    for (const std::uint32_t bit : shared) {
      for (const std::uint32_t next : {(bit - 1) & mask_, (bit + 1) & mask_}) {
        bits_[next / 8] |= static_cast<std::uint8_t>(1U << next % 8);
      }
    }
  }
  bits_[size / 8] = bits_[0];
}

// Those of the animals first .. last - 1 that see a second bit; `before` come before the crowd.
template <typename T>
void Company<T>::LookUp(const Crowd<T>& crowd, std::int64_t first, std::int64_t last,
                        std::size_t before, std::vector<Animal>* found) const {
  std::uint32_t company[kCrowdGrain], lowest[kCrowdGrain];
  std::uint32_t count = 0;
  std::int64_t k = first;
  if constexpr (std::is_same_v<T, float>) {
    const auto whole = static_cast<std::uint32_t>((last - first) / 8 * 8);
    const CompanyJob job{{crowd.x + first, crowd.y + first, crowd.z + first, per_cell_, T(0.5),
                          across_y_, across_z_, nullptr},
                         bits_.data(),
                         mask_};
    count = FastestSwarmKernel().company(job, 0, whole, company, lowest);
    k += whole;
  }
  const auto bit = [this](std::uint32_t cell) {
    const std::uint32_t at = cell & mask_;
    return bits_[at / 8] >> at % 8 & 1;
  };
  for (; k < last; ++k) {
    const std::uint32_t at = Cell(crowd.x[k], crowd.y[k], crowd.z[k], T(0.5));
    int seen = 0;
    for (const std::uint32_t across : {0U, across_y_, across_z_, across_y_ + across_z_}) {
      seen += bit(at + across) + bit(at + across + 1);
    }
    company[count] = static_cast<std::uint32_t>(k - first);
    lowest[count] = at;
    count += seen > 1 ? 1 : 0;
  }
  const auto start = static_cast<std::uint32_t>(before + static_cast<std::size_t>(first));
  found->clear();
  for (std::uint32_t n = 0; n < count; ++n) found->push_back({start + company[n], lowest[n]});
}

template <typename T>
void Company<T>::Find(std::span<const Crowd<T>> crowds, const CrowdBox<T>& box, T reach,
                      ThreadPool* pool) {
  std::size_t total = 0;
  for (const Crowd<T>& crowd : crowds) total += crowd.size;
  NumberLattice(box, reach, total);
  cell_.resize(total);
  std::size_t before = 0;
  for (const Crowd<T>& crowd : crowds) {
    pool->For(0, static_cast<std::int64_t>(crowd.size), kCrowdGrain,
              [&](std::int64_t first, std::int64_t last) {
                Number(crowd, first, last, cell_.data() + before);
              });
    before += crowd.size;
  }
  SetBits(pool);

  animals_.clear();
  before = 0;
  for (const Crowd<T>& crowd : crowds) {
    found_.resize((crowd.size + kCrowdGrain - 1) / kCrowdGrain);
    pool->For(0, static_cast<std::int64_t>(crowd.size), kCrowdGrain,
              [&](std::int64_t first, std::int64_t last) {
                LookUp(crowd, first, last, before, &found_[first / kCrowdGrain]);
              });
    for (const auto& found : found_) animals_.insert(animals_.end(), found.begin(), found.end());
    before += crowd.size;
  }
}

template class Company<float>;
template class Company<double>;

}  // namespace flocklift
