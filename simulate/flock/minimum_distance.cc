// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/minimum_distance.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>

#include "simulate/flock/kernels/swarm_kernel.h"

namespace flocklift {
namespace {

constexpr std::int64_t kGrain = 2048;         // animals a chunk of work
constexpr double kCellPerReach = 1.05;        // half a cell against the largest distance; round-off
constexpr std::size_t kCellsPerAnimal = 16;   // of the first table
constexpr std::size_t kBucketsPerAnimal = 4;  // of the second
constexpr std::uint32_t kAcrossY = 0x9E3779B1U, kAcrossZ = 0x85EBCA77U;  // odd; along x: 1

// The next power of two of `least`, at least 64.
std::uint32_t TableSize(std::size_t least) {
  return static_cast<std::uint32_t>(std::bit_ceil(std::max<std::size_t>(least, 64)));
}

// What the first table says of a cell that holds one animal: which of the cells that share its
// entry it is, 1 to 127. An entry with several animals, of whichever cells, has kSeveral besides.
constexpr std::uint8_t kSeveral = 128;
std::uint8_t Tag(std::uint32_t cell) {
  const std::uint32_t tag = cell >> 25;
  return static_cast<std::uint8_t>(tag + (tag == 0 ? 1 : 0));
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

// The number of the cell of a place. `shift`, in cells, is taken off the place before: with
// 1/2 this is the lowest of the eight cells that hold all that may be too near, the others being
// further by 1, kAcrossY, kAcrossZ and their sums.
template <typename T>
std::uint32_t Cell(T x, T y, T z, T per_cell, T shift) {
  return Floor(x * per_cell - shift) + Floor(y * per_cell - shift) * kAcrossY +
         Floor(z * per_cell - shift) * kAcrossZ;
}

}  // namespace

template <typename T>
void MinimumDistance<T>::NumberCells(std::span<const Crowd<T>> crowds, T per_cell, T shift,
                                     ThreadPool* pool) {
  cell_.resize(places_.size());
  std::uint32_t* to = cell_.data();
  for (const Crowd<T>& crowd : crowds) {
    pool->For(0, static_cast<std::int64_t>(crowd.size), kGrain,
              [&](std::int64_t first, std::int64_t last) {
                std::int64_t k = first;
                if constexpr (std::is_same_v<T, float>) {
                  k = first + (last - first) / 8 * 8;
                  FastestSwarmKernel().cells(
                      {crowd.x, crowd.y, crowd.z, per_cell, shift, kAcrossY, kAcrossZ, to},
                      static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(k));
                }
                for (; k < last; ++k) {
                  to[k] = Cell(crowd.x[k], crowd.y[k], crowd.z[k], per_cell, shift);
                }
              });
    to += crowd.size;
  }
}

template <typename T>
void MinimumDistance<T>::Gather(std::span<const Crowd<T>> crowds, ThreadPool* pool) {
  std::size_t total = 0;
  for (const Crowd<T>& crowd : crowds) total += crowd.size;
  places_.resize(total);
  Place* to = places_.data();
  for (const Crowd<T>& crowd : crowds) {
    pool->For(0, static_cast<std::int64_t>(crowd.size), kGrain,
              [&](std::int64_t first, std::int64_t last) {
                for (std::int64_t k = first; k < last; ++k) {
                  to[k] = {crowd.x[k], crowd.y[k], crowd.z[k],
                           crowd.body != nullptr ? crowd.room + crowd.body[k] : crowd.room};
                }
              });
    to += crowd.size;
  }
}

template <typename T>
void MinimumDistance<T>::Enter(ThreadPool* pool) {
  const std::uint32_t size = TableSize(kCellsPerAnimal * places_.size()), mask = size - 1;
  entries_.resize(size + 1);
  // Every thread looks at all animals and enters those of its part of the table.
  const std::uint32_t parts = std::bit_floor(static_cast<unsigned>(pool->threads()));
  const int shift = std::countr_zero(size / parts);
  pool->For(0, parts, 1, [&](std::int64_t part, std::int64_t) {
    std::uint8_t* const entries = entries_.data();
    std::fill_n(entries + (part << shift), std::size_t{1} << shift, std::uint8_t{0});
    for (const std::uint32_t cell : cell_) {
      const std::uint32_t at = cell & mask;
      if (parts > 1 && at >> shift != static_cast<std::uint32_t>(part)) continue;
      const std::uint8_t before = entries[at], tag = Tag(cell);
      entries[at] = before == 0 ? tag : static_cast<std::uint8_t>(before | kSeveral);
    }
  });
  entries_[size] = entries_[0];  // so that two neighbours along x may always be read together
}

template <typename T>
bool MinimumDistance<T>::HasCompany(std::uint32_t lowest) const {
  const auto mask = static_cast<std::uint32_t>(entries_.size() - 2);
  int seen = 0;
  for (const std::uint32_t across : {0U, kAcrossY, kAcrossZ, kAcrossY + kAcrossZ}) {
    for (const std::uint32_t cell : {lowest + across, lowest + across + 1}) {
      const std::uint8_t entry = entries_[cell & mask];
      seen += entry == Tag(cell) ? 1 : entry >= kSeveral ? 2 : 0;
    }
  }
  return seen > 1;  // one is the animal itself
}

template <typename T>
void MinimumDistance<T>::FindCompany(ThreadPool* pool) {
  const auto n = static_cast<std::int64_t>(places_.size());
  const auto mask = static_cast<std::uint32_t>(entries_.size() - 2);
  company_.resize(static_cast<std::size_t>((n + kGrain - 1) / kGrain));
  pool->For(0, n, kGrain, [&](std::int64_t first, std::int64_t last) {
    const std::uint8_t* const entries = entries_.data();
    std::vector<std::uint32_t>& found = company_[static_cast<std::size_t>(first / kGrain)];
    found.resize(static_cast<std::size_t>(last - first));
    // First those with anything at all in the eight entries but themselves, without branches.
    std::size_t count = 0;
    for (std::int64_t k = first; k < last; ++k) {
      const std::uint32_t lowest = cell_[k];
      const auto row = [&](std::uint32_t across) -> std::uint64_t {
        const std::uint8_t* const at = entries + (mask & (lowest + across));
        return at[0] | static_cast<std::uint64_t>(at[1]) << 8;
      };
      const std::uint64_t all =
          row(0) | row(kAcrossY) << 16 | row(kAcrossZ) << 32 | row(kAcrossY + kAcrossZ) << 48;
      const std::uint64_t tops = 0x8080808080808080U, several = all & tops;
      const std::uint64_t taken = (((all & ~tops) + ~tops) & tops) >> 7;  // a bit for each entry
      found[count] = static_cast<std::uint32_t>(k);
      count += (taken & (taken - 1)) != 0 || several != 0 ? 1 : 0;
    }
    const auto alone = [this](std::uint32_t k) { return !HasCompany(cell_[k]); };
    const auto end = found.begin() + static_cast<std::ptrdiff_t>(count);
    found.erase(std::remove_if(found.begin(), end, alone), found.end());
  });
  crowded_.clear();
  for (const auto& found : company_) crowded_.insert(crowded_.end(), found.begin(), found.end());
}

template <typename T>
void MinimumDistance<T>::Chain(T per_cell) {
  const std::uint32_t buckets = TableSize(kBucketsPerAnimal * crowded_.size());
  head_.assign(buckets, -1);
  next_.resize(crowded_.size());
  close_.resize(crowded_.size());
  for (std::size_t k = 0; k < crowded_.size(); ++k) {
    const Place p = places_[crowded_[k]];
    const std::uint32_t bucket = Cell(p.x, p.y, p.z, per_cell, T(0)) & (buckets - 1);
    close_[k] = p;
    next_[k] = head_[bucket];
    head_[bucket] = static_cast<std::int32_t>(k);
  }
}

template <typename T>
Vec3<T> MinimumDistance<T>::Push(std::size_t self, bool* touched) const {
  const Place p = close_[self];
  const std::uint32_t lowest = cell_[crowded_[self]];
  const auto mask = static_cast<std::uint32_t>(head_.size() - 1);
  std::uint32_t buckets[8];
  int count = 0;
  Vec3<T> push{};
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    const std::uint32_t bucket =
        mask & (lowest + (corner & 1) + (corner >> 1 & 1) * kAcrossY + (corner >> 2) * kAcrossZ);
    // Two cells may share a bucket; each is walked through once.
    if (head_[bucket] < 0 || std::find(buckets, buckets + count, bucket) != buckets + count) {
      continue;
    }
    buckets[count++] = bucket;
    for (std::int32_t other = head_[bucket]; other >= 0; other = next_[other]) {
      const auto j = static_cast<std::size_t>(other);
      const Place& q = close_[j];
      const Vec3<T> r{q.x - p.x, q.y - p.y, q.z - p.z};
      const T squared = SquaredNorm(r), least = p.room + q.room;
      if (!(squared < least * least) || j == self) continue;
      *touched = true;
      const T length = std::sqrt(squared), half = T(0.5) * (least - length);
      push -= length > 0 ? r * (half / length) : Vec3<T>{j > self ? half : -half, T(0), T(0)};
    }
  }
  return push;
}

// Distances are those of the grid's copies, so that positions may be moved meanwhile.
template <typename T>
std::int64_t MinimumDistance<T>::EnforceInGrid(std::span<const Crowd<T>> crowds, ThreadPool* pool) {
  grid_.FindPairs(pool);
  std::size_t total = 0;
  for (const Crowd<T>& crowd : crowds) total += crowd.size;
  touched_.assign(total, 0);
  std::int64_t moved = 0;
  const auto move = [&](std::uint32_t animal, const Vec3<T>& push) {
    moved += touched_[animal] == 0 ? 1 : 0;
    touched_[animal] = 1;
    std::size_t crowd = 0, at = animal;
    while (at >= crowds[crowd].size) at -= crowds[crowd++].size;
    crowds[crowd].x[at] += push.x;
    crowds[crowd].y[at] += push.y;
    crowds[crowd].z[at] += push.z;
  };
  for (const auto& pairs : grid_.pairs()) {
    for (const auto& pair : pairs) {
      const T length = std::sqrt(pair.squared), half = T(0.5) * (pair.distance - length);
      const Vec3<T> push = length > 0 ? pair.way * (half / length) : Vec3<T>{half, T(0), T(0)};
      move(grid_.Animal(pair.first), -push);
      move(grid_.Animal(pair.second), push);
    }
  }
  return moved;
}

template <typename T>
std::int64_t MinimumDistance<T>::Enforce(std::span<const Crowd<T>> crowds, ThreadPool* pool) {
  std::size_t total = 0;
  T most = 0;
  for (const Crowd<T>& crowd : crowds) {
    total += crowd.size;
    if (crowd.body == nullptr) most = std::max(most, crowd.room);
  }
  for (const Crowd<T>& crowd : crowds) {
    for (std::size_t k = 0; crowd.body != nullptr && k < crowd.size; ++k) {
      most = std::max(most, crowd.room + crowd.body[k]);
    }
  }
  if (!(most > 0) || total < 2) return 0;
  if (grid_.Sort(crowds, 2 * most, pool)) return EnforceInGrid(crowds, pool);
  Gather(crowds, pool);
  const T per_cell = T(1) / static_cast<T>(2 * kCellPerReach * 2 * static_cast<double>(most));
  NumberCells(crowds, per_cell, T(0), pool);
  Enter(pool);
  NumberCells(crowds, per_cell, T(0.5), pool);
  FindCompany(pool);
  Chain(per_cell);

  const auto crowded = static_cast<std::int64_t>(crowded_.size());
  push_.resize(crowded_.size());
  touched_.assign(crowded_.size(), 0);
  pool->For(0, crowded, kGrain / 8, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t k = first; k < last; ++k) {
      bool touched = false;
      push_[k] = Push(static_cast<std::size_t>(k), &touched);
      touched_[k] = touched ? 1 : 0;
    }
  });
  std::int64_t moved = 0;
  std::size_t crowd = 0, before = 0;  // the species of an animal, and how many are in those before
  for (std::size_t k = 0; k < crowded_.size(); ++k) {
    while (crowded_[k] - before >= crowds[crowd].size) before += crowds[crowd++].size;
    if (touched_[k] == 0) continue;
    ++moved;
    const std::size_t at = crowded_[k] - before;
    crowds[crowd].x[at] += push_[k].x;
    crowds[crowd].y[at] += push_[k].y;
    crowds[crowd].z[at] += push_[k].z;
  }
  return moved;
}

template class MinimumDistance<float>;
template class MinimumDistance<double>;

}  // namespace flocklift
