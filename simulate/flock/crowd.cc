// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/crowd.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <vector>
#include <xsimd/xsimd.hpp>

namespace flocklift {
namespace {

// Least and largest, several at a time; compilers do not take it to packs by themselves.
template <typename T>
void Widen(const T* v, std::size_t first, std::size_t last, T* least, T* most) {
  using Pack = xsimd::batch<T, xsimd::sse2>;
  constexpr std::size_t kAtOnce = 4;  // so that they do not wait for each other
  Pack low[kAtOnce], high[kAtOnce];
  std::fill_n(low, kAtOnce, Pack(*least));
  std::fill_n(high, kAtOnce, Pack(*most));
  std::size_t k = first;
  for (; k + kAtOnce * Pack::size <= last; k += kAtOnce * Pack::size) {
    for (std::size_t n = 0; n < kAtOnce; ++n) {
      const Pack value = Pack::load_unaligned(v + k + n * Pack::size);
      low[n] = xsimd::min(value, low[n]);  // the second where the first is not a number
      high[n] = xsimd::max(value, high[n]);
    }
  }
  T lows[kAtOnce * Pack::size], highs[kAtOnce * Pack::size];
  for (std::size_t n = 0; n < kAtOnce; ++n) {
    low[n].store_unaligned(lows + n * Pack::size);
    high[n].store_unaligned(highs + n * Pack::size);
  }
  *least = *std::min_element(std::begin(lows), std::end(lows));
  *most = *std::max_element(std::begin(highs), std::end(highs));
  for (; k < last; ++k) {
    *least = v[k] < *least ? v[k] : *least;
    *most = v[k] > *most ? v[k] : *most;
  }
}

}  // namespace

template <typename T>
std::vector<CrowdBox<T>> BoxesOf(std::span<const Crowd<T>> crowds, ThreadPool* pool) {
  std::size_t count = 0;
  for (const Crowd<T>& crowd : crowds) count += (crowd.size + kCrowdGrain - 1) / kCrowdGrain;
  std::vector<CrowdBox<T>> boxes(count, Around<T>({}));
  CrowdBox<T>* of_crowd = boxes.data();
  for (const Crowd<T>& crowd : crowds) {
    pool->For(0, static_cast<std::int64_t>(crowd.size), kCrowdGrain,
              [&](std::int64_t first, std::int64_t last) {
                CrowdBox<T> box = Around<T>({});
                const auto a = static_cast<std::size_t>(first), b = static_cast<std::size_t>(last);
                Widen(crowd.x, a, b, &box.low.x, &box.high.x);
                Widen(crowd.y, a, b, &box.low.y, &box.high.y);
                Widen(crowd.z, a, b, &box.low.z, &box.high.z);
                of_crowd[first / kCrowdGrain] = box;
              });
    of_crowd += (crowd.size + kCrowdGrain - 1) / kCrowdGrain;
  }
  return boxes;
}

template <typename T>
CrowdBox<T> Around(std::span<const CrowdBox<T>> boxes) {
  const T far = std::numeric_limits<T>::max();
  CrowdBox<T> all{{far, far, far}, {-far, -far, -far}};
  for (const CrowdBox<T>& box : boxes) {
    all.low = {std::min(all.low.x, box.low.x), std::min(all.low.y, box.low.y),
               std::min(all.low.z, box.low.z)};
    all.high = {std::max(all.high.x, box.high.x), std::max(all.high.y, box.high.y),
                std::max(all.high.z, box.high.z)};
  }
  return all;
}

template std::vector<CrowdBox<float>> BoxesOf(std::span<const Crowd<float>>, ThreadPool*);
template std::vector<CrowdBox<double>> BoxesOf(std::span<const Crowd<double>>, ThreadPool*);
template CrowdBox<float> Around(std::span<const CrowdBox<float>>);
template CrowdBox<double> Around(std::span<const CrowdBox<double>>);

}  // namespace flocklift
