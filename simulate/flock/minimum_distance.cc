// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/minimum_distance.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace flocklift {
namespace {

constexpr double kSparse = 1.0 / 32;          // animals a cell of Company, on average
constexpr std::size_t kBucketsPerAnimal = 4;  // of the hashed table

// Calls fn(k, crowd, at) for each animal with company: number k of them, and animal `at` of a
// crowd.
template <typename T, typename Function>
void ForEachWithCompany(const Company<T>& company, std::span<const Crowd<T>> crowds,
                        const Function& fn) {
  std::size_t crowd = 0, before = 0;
  for (std::size_t k = 0; k < company.animals().size(); ++k) {
    const std::size_t animal = company.animals()[k].animal;
    while (animal - before >= crowds[crowd].size) before += crowds[crowd++].size;
    fn(k, crowds[crowd], animal - before);
  }
}

}  // namespace

template <typename T>
void MinimumDistance<T>::Gather(std::span<const Crowd<T>> crowds) {
  for (std::vector<T>* column : {&x_, &y_, &z_, &room_}) column->resize(company_.animals().size());
  ForEachWithCompany(company_, crowds,
                     [this](std::size_t k, const Crowd<T>& crowd, std::size_t at) {
                       x_[k] = crowd.x[at];
                       y_[k] = crowd.y[at];
                       z_[k] = crowd.z[at];
                       room_[k] = crowd.RoomOf(at);
                     });
}

template <typename T>
void MinimumDistance<T>::PutBack(std::span<const Crowd<T>> crowds) const {
  ForEachWithCompany(company_, crowds,
                     [this](std::size_t k, const Crowd<T>& crowd, std::size_t at) {
                       crowd.x[at] = x_[k];
                       crowd.y[at] = y_[k];
                       crowd.z[at] = z_[k];
                     });
}

template <typename T>
Crowd<T> MinimumDistance<T>::Close() {
  return {x_.size(), x_.data(), y_.data(), z_.data(), T(0), room_.data()};
}

template <typename T>
void MinimumDistance<T>::Chain() {
  const std::size_t buckets =
      std::bit_ceil(std::max<std::size_t>(kBucketsPerAnimal * x_.size(), 64));
  head_.assign(buckets, -1);
  next_.resize(x_.size());
  for (std::size_t k = 0; k < x_.size(); ++k) {
    const std::size_t bucket = company_.Cell(x_[k], y_[k], z_[k]) & (buckets - 1);
    next_[k] = head_[bucket];
    head_[bucket] = static_cast<std::int32_t>(k);
  }
}

template <typename T>
Vec3<T> MinimumDistance<T>::Push(std::size_t self, bool* touched) const {
  const std::uint32_t lowest = company_.animals()[self].lowest;
  const auto mask = static_cast<std::uint32_t>(head_.size() - 1);
  std::uint32_t buckets[8];
  int count = 0;
  Vec3<T> push{};
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    const std::uint32_t bucket =
        mask & (lowest + (corner & 1) + (corner >> 1 & 1) * company_.across_y() +
                (corner >> 2) * company_.across_z());
    // Two cells may share a bucket; each is walked through once.
    if (head_[bucket] < 0 || std::find(buckets, buckets + count, bucket) != buckets + count) {
      continue;
    }
    buckets[count++] = bucket;
    for (std::int32_t other = head_[bucket]; other >= 0; other = next_[other]) {
      const auto j = static_cast<std::size_t>(other);
      const Vec3<T> r{x_[j] - x_[self], y_[j] - y_[self], z_[j] - z_[self]};
      const T squared = SquaredNorm(r), least = room_[self] + room_[j];
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
std::int64_t MinimumDistance<T>::EnforceInTable(ThreadPool* pool) {
  Chain();
  const std::size_t count = x_.size();
  push_.resize(count);
  touched_.assign(count, 0);
  pool->For(0, static_cast<std::int64_t>(count), kCrowdGrain / 8,
            [&](std::int64_t first, std::int64_t last) {
              for (auto k = static_cast<std::size_t>(first); k < static_cast<std::size_t>(last);
                   ++k) {
                bool touched = false;
                push_[k] = Push(k, &touched);
                touched_[k] = touched ? 1 : 0;
              }
            });
  std::int64_t moved = 0;
  for (std::size_t k = 0; k < count; ++k) {
    moved += touched_[k];
    x_[k] += push_[k].x;
    y_[k] += push_[k].y;
    z_[k] += push_[k].z;
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
    for (std::size_t k = 0; crowd.body != nullptr && k < crowd.size; ++k) {
      most = std::max(most, crowd.room + crowd.body[k]);
    }
  }
  if (!(most > 0) || total < 2) return 0;
  const T reach = 2 * most;
  const CrowdBox<T> box = BoxAround(crowds, pool);
  const bool sparse = Company<T>::Density(crowds, box, reach) < kSparse;
  if (!sparse && grid_.Sort(crowds, box, reach, pool)) return EnforceInGrid(crowds, pool);
  company_.Find(crowds, box, reach, pool);
  Gather(crowds);
  const Crowd<T> close = Close();
  const std::int64_t moved = grid_.Sort({&close, 1}, box, reach, pool)
                                 ? EnforceInGrid({&close, 1}, pool)
                                 : EnforceInTable(pool);
  PutBack(crowds);
  return moved;
}

template class MinimumDistance<float>;
template class MinimumDistance<double>;

}  // namespace flocklift
