// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Least and greatest of a column's values, over whole lanes so that it runs on packs. The order in
// which values and parts of a column are taken does not count.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_EXTENT_H_
#define FLOCKLIFT_SIMULATE_FLOCK_EXTENT_H_

#include <algorithm>
#include <cstddef>

namespace flocklift {

template <typename T>
struct Extent {
  T low, high;
  bool finite;  // all of the values; else low and high mean nothing
};

template <typename T>
Extent<T> Join(const Extent<T>& a, const Extent<T>& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high), a.finite && b.finite};
}

// Of values[first] .. values[last - 1], first < last.
template <typename T, typename Column>
Extent<T> ExtentOf(const Column& values, std::size_t first, std::size_t last) {
  constexpr std::size_t kLanes = 8;
  T low[kLanes], high[kLanes], zero[kLanes] = {};
  std::fill_n(low, kLanes, values[first]);
  std::fill_n(high, kLanes, values[first]);
  const auto take = [&](std::size_t lane, T value) {
    low[lane] = value < low[lane] ? value : low[lane];
    high[lane] = value > high[lane] ? value : high[lane];
    zero[lane] += value - value;  // 0, unless it is not finite
  };
  std::size_t k = first;
  for (; k + kLanes <= last; k += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) take(lane, values[k + lane]);
  }
  for (; k < last; ++k) take(0, values[k]);
  return {*std::min_element(low, low + kLanes), *std::max_element(high, high + kLanes),
          std::all_of(zero, zero + kLanes, [](T value) { return value == T(0); })};
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_EXTENT_H_
