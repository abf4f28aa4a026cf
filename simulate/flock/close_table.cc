// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/close_table.h"

#include <algorithm>
#include <bit>
#include <type_traits>

#include "simulate/flock/kernels/swarm_kernel.h"

namespace flocklift {
namespace {

constexpr std::size_t kBucketsPerAnimal = 1;
constexpr std::size_t kLeastBuckets = 64;
constexpr std::size_t kPadding = 16;

}  // namespace

template <typename T>
void CloseTable<T>::Sort(const Company<T>& company) {
  const auto& found = company.found();
  const std::size_t n = found.size();
  const std::size_t buckets = std::bit_ceil(std::max(kBucketsPerAnimal * n, kLeastBuckets));
  mask_ = static_cast<std::uint32_t>(buckets - 1);
  across_y_ = company.across_y();
  across_z_ = company.across_z();
  start_.resize(buckets + 2);
  for (std::vector<T>* column : {&x_, &y_, &z_, &room_}) column->resize(n + kPadding);
  animal_.resize(n);
  low_.resize(n);

  next_.assign(buckets, 0);
  for (const auto& animal : found) ++next_[animal.cell & mask_];
  std::uint32_t sum = 0;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    const std::uint32_t count = next_[bucket];
    start_[bucket] = next_[bucket] = sum;
    sum += count;
  }
  start_[buckets] = start_[buckets + 1] = sum;
  for (const auto& animal : found) {
    const std::uint32_t to = next_[animal.cell & mask_]++;
    x_[to] = animal.x;
    y_[to] = animal.y;
    z_[to] = animal.z;
    room_[to] = animal.room;
    animal_[to] = animal.animal;
    low_[to] = animal.lowest;
  }
}

template <typename T>
void CloseTable<T>::AppendPairs(std::uint32_t first) {
  const std::size_t before = pairs_.size();
  // Two of the eight cells may share a bucket.
  const auto has = [&](std::uint32_t j) {
    return std::any_of(pairs_.begin() + static_cast<std::ptrdiff_t>(before), pairs_.end(),
                       [j](const ClosePair<T>& pair) { return pair.second == j; });
  };
  const auto look_through = [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t j = std::max(begin, first + 1); j < end; ++j) {
      const Vec3<T> way{x_[j] - x_[first], y_[j] - y_[first], z_[j] - z_[first]};
      const T squared = way.x * way.x + way.y * way.y + way.z * way.z;
      const T distance = room_[first] + room_[j];
      if (squared < distance * distance && !has(j)) {
        pairs_.push_back({first, j, way, squared, distance});
      }
    }
  };
  for (const std::uint32_t across : {0U, across_y_, across_z_, across_y_ + across_z_}) {
    const std::uint32_t bucket = (low_[first] + across) & mask_;
    look_through(start_[bucket], start_[bucket + 2]);
    if (bucket == mask_) look_through(start_[0], start_[1]);
  }
}

template <typename T>
void CloseTable<T>::FindPairs() {
  const auto n = static_cast<std::uint32_t>(animal_.size());
  pairs_.clear();
  if constexpr (std::is_same_v<T, float>) {
    has_.resize(n);
    const CloseJob job{x_.data(),     y_.data(), z_.data(), room_.data(), low_.data(),
                       start_.data(), across_y_, across_z_, mask_};
    const std::uint32_t count = FastestSwarmKernel().close(job, 0, n, has_.data());
    for (std::uint32_t k = 0; k < count; ++k) AppendPairs(has_[k]);
  } else {
    for (std::uint32_t k = 0; k < n; ++k) AppendPairs(k);
  }
}

template class CloseTable<float>;
template class CloseTable<double>;

}  // namespace flocklift
