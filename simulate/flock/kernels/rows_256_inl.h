// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Eight vectors fetched by number, from rows of eight numbers each; included once by each variant
// with packs of 256 bits. A row is read whole and turned in registers, which beats gathering.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_ROWS_256_INL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_ROWS_256_INL_H_

#include <immintrin.h>

#include <cstddef>
#include <cstdint>

#include "simulate/core/vec3.h"

namespace flocklift {
namespace {

struct EightVectors {
  __m256 x, y, z;
};

// Numbers 0, 1 and 2 of the rows places[0 .. 7].
[[gnu::always_inline]] inline EightVectors FetchEight(const float* rows,
                                                      const std::uint32_t* places) {
  const auto both = [&](int k) __attribute__((always_inline)) {  // k in the low half, k + 4 above
    const auto row = [&](int n) { return _mm_loadu_ps(rows + std::size_t{8} * places[n]); };
    return _mm256_insertf128_ps(_mm256_castps128_ps256(row(k)), row(k + 4), 1);
  };
  const __m256 a = both(0), b = both(1), c = both(2), d = both(3);
  const __m256 ab = _mm256_unpacklo_ps(a, b), cd = _mm256_unpacklo_ps(c, d);  // x x y y
  const __m256 ab_z = _mm256_unpackhi_ps(a, b), cd_z = _mm256_unpackhi_ps(c, d);
  return {_mm256_shuffle_ps(ab, cd, 0x44), _mm256_shuffle_ps(ab, cd, 0xEE),
          _mm256_shuffle_ps(ab_z, cd_z, 0x44)};
}

}  // namespace
}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_ROWS_256_INL_H_
