// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/minimum_distance.h"

#include <algorithm>
#include <cmath>

#include "simulate/flock/company.h"

namespace flocklift {
namespace {

constexpr double kSparse = 1.0 / 32;  // animals a cell of Company, on average

}  // namespace

// Distances are those of the sort's copies, so that positions may be moved meanwhile.
template <typename T>
template <typename Pairs>
std::int64_t MinimumDistance<T>::PushApart(const Pairs& sorted, std::span<const Crowd<T>> crowds) {
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
  for (const auto& pairs : sorted.pairs()) {
    for (const auto& pair : pairs) {
      const T length = std::sqrt(pair.squared), half = T(0.5) * (pair.distance - length);
      const Vec3<T> push = length > 0 ? pair.way * (half / length) : Vec3<T>{half, T(0), T(0)};
      move(sorted.Animal(pair.first), -push);
      move(sorted.Animal(pair.second), push);
    }
  }
  return moved;
}

template <typename T>
std::int64_t MinimumDistance<T>::Enforce(std::span<const Crowd<T>> crowds,
                                         std::span<const CrowdBox<T>> boxes, ThreadPool* pool) {
  std::size_t total = 0;
  T most = 0;
  for (const Crowd<T>& crowd : crowds) {
    total += crowd.size;
    if (crowd.body == nullptr || crowd.largest_body > 0) {
      most = std::max(most, crowd.room + crowd.largest_body);
      continue;
    }
    for (std::size_t k = 0; k < crowd.size; ++k) most = std::max(most, crowd.RoomOf(k));
  }
  if (!(most > 0) || total < 2) return 0;
  const T reach = 2 * most;
  const CrowdBox<T> box = Around<T>(boxes);
  const bool sparse = Company<T>::Density(crowds, box, reach) < kSparse;
  if (!sparse && grid_.Sort(crowds, box, reach, pool)) {
    grid_.FindPairs(pool);
    return PushApart(grid_, crowds);
  }
  patches_.FindPairs(crowds, boxes, reach, pool);
  return PushApart(patches_, crowds);
}

template class MinimumDistance<float>;
template class MinimumDistance<double>;

}  // namespace flocklift
