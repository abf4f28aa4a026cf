// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/crowd.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace flocklift {
namespace {

constexpr std::size_t kLanes = 8;

// Least and largest.
template <typename T>
void Widen(const T* v, std::size_t first, std::size_t last, T* least, T* most) {
  T low[kLanes], high[kLanes];
  std::fill_n(low, kLanes, *least);
  std::fill_n(high, kLanes, *most);
  std::size_t k = first;
  for (; k + kLanes <= last; k += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const T value = v[k + lane];
      low[lane] = value < low[lane] ? value : low[lane];
      high[lane] = value > high[lane] ? value : high[lane];
    }
  }
  for (; k < last; ++k) {
    low[0] = v[k] < low[0] ? v[k] : low[0];
    high[0] = v[k] > high[0] ? v[k] : high[0];
  }
  *least = *std::min_element(low, low + kLanes);
  *most = *std::max_element(high, high + kLanes);
}

}  // namespace

template <typename T>
CrowdBox<T> BoxAround(std::span<const Crowd<T>> crowds, ThreadPool* pool) {
  const T far = std::numeric_limits<T>::max();
  const CrowdBox<T> nobody{{far, far, far}, {-far, -far, -far}};
  CrowdBox<T> all = nobody;
  for (const Crowd<T>& crowd : crowds) {
    std::vector<CrowdBox<T>> boxes((crowd.size + kCrowdGrain - 1) / kCrowdGrain, nobody);
    pool->For(0, static_cast<std::int64_t>(crowd.size), kCrowdGrain,
              [&](std::int64_t first, std::int64_t last) {
                CrowdBox<T> box = nobody;
                const auto a = static_cast<std::size_t>(first), b = static_cast<std::size_t>(last);
                Widen(crowd.x, a, b, &box.low.x, &box.high.x);
                Widen(crowd.y, a, b, &box.low.y, &box.high.y);
                Widen(crowd.z, a, b, &box.low.z, &box.high.z);
                boxes[static_cast<std::size_t>(first / kCrowdGrain)] = box;
              });
    for (const CrowdBox<T>& box : boxes) {
      all.low = {std::min(all.low.x, box.low.x), std::min(all.low.y, box.low.y),
                 std::min(all.low.z, box.low.z)};
      all.high = {std::max(all.high.x, box.high.x), std::max(all.high.y, box.high.y),
                  std::max(all.high.z, box.high.z)};
    }
  }
  return all;
}

template CrowdBox<float> BoxAround(std::span<const Crowd<float>>, ThreadPool*);
template CrowdBox<double> BoxAround(std::span<const Crowd<double>>, ThreadPool*);

}  // namespace flocklift
