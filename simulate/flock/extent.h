// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Least and greatest of a column's values, in packs, to which compilers do not take it by
// themselves. The order in which values and parts of a column are taken does not count.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_EXTENT_H_
#define FLOCKLIFT_SIMULATE_FLOCK_EXTENT_H_

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>
#include <xsimd/xsimd.hpp>

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

template <typename T>
using ExtentPack = xsimd::batch<T, xsimd::sse2>;

// The values from the k-th on; other columns than these have their own.
template <typename T>
ExtentPack<T> PackAt(const T* values, std::size_t k) {
  return ExtentPack<T>::load_unaligned(values + k);
}
template <typename T>
ExtentPack<T> PackAt(const std::vector<T>& values, std::size_t k) {
  return PackAt(values.data(), k);
}

// Of values[first] .. values[last - 1], first < last.
template <typename T, typename Column>
Extent<T> ExtentOf(const Column& values, std::size_t first, std::size_t last) {
  using Pack = ExtentPack<T>;
  constexpr std::size_t kAtOnce = 4;  // so that they do not wait for each other
  Pack low[kAtOnce], high[kAtOnce], zero[kAtOnce];
  std::fill_n(low, kAtOnce, Pack(values[first]));
  std::fill_n(high, kAtOnce, Pack(values[first]));
  std::fill_n(zero, kAtOnce, Pack(T(0)));
  std::size_t k = first;
  for (; k + kAtOnce * Pack::size <= last; k += kAtOnce * Pack::size) {
    for (std::size_t n = 0; n < kAtOnce; ++n) {
      const Pack value = PackAt(values, k + n * Pack::size);
      low[n] = xsimd::min(low[n], value);
      high[n] = xsimd::max(high[n], value);
      zero[n] += value - value;  // 0, unless it is not finite
    }
  }
  for (std::size_t n = 1; n < kAtOnce; ++n) {
    low[0] = xsimd::min(low[0], low[n]);
    high[0] = xsimd::max(high[0], high[n]);
    zero[0] += zero[n];
  }
  T lows[Pack::size], highs[Pack::size], zeros[Pack::size];
  low[0].store_unaligned(lows);
  high[0].store_unaligned(highs);
  zero[0].store_unaligned(zeros);
  T sum = std::accumulate(zeros, zeros + Pack::size, T(0));
  Extent<T> all{*std::min_element(lows, lows + Pack::size),
                *std::max_element(highs, highs + Pack::size), true};
  for (; k < last; ++k) {
    all.low = std::min(all.low, values[k]);
    all.high = std::max(all.high, values[k]);
    sum += values[k] - values[k];
  }
  all.finite = sum == T(0);
  return all;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_EXTENT_H_
