// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the swarm kernel does its own way with packs of 256 bits; FLOCKLIFT_SWARM_ARCH names the
// instruction set. Gradients come from three tables of sixteen bytes: a byte is the top of a float,
// and 2, -2 and 0 have nothing below it.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SWARM_256_INL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SWARM_256_INL_H_

#include <immintrin.h>

#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "simulate/flock/kernels/lattice_pack.h"

namespace flocklift {

template <>
struct GradientOfPack<FLOCKLIFT_SWARM_ARCH> {
  using Pack = xsimd::batch<float, FLOCKLIFT_SWARM_ARCH>;
  using Bits = xsimd::batch<std::uint32_t, FLOCKLIFT_SWARM_ARCH>;

  // Component `axis` of the sixteen gradients, in both halves.
  [[gnu::always_inline]] static __m256i Table(int axis) {
    const auto byte = [axis](int k) __attribute__((always_inline)) {
      const int component = kDoubledGradients[k][axis];
      return static_cast<char>(component == 0 ? 0 : component > 0 ? 0x40 : 0xC0);
    };
    const __m128i table =
        _mm_setr_epi8(byte(0), byte(1), byte(2), byte(3), byte(4), byte(5), byte(6), byte(7),
                      byte(8), byte(9), byte(10), byte(11), byte(12), byte(13), byte(14), byte(15));
    return _mm256_broadcastsi128_si256(table);
  }

  [[gnu::always_inline]] static Vec3<Pack> At(const Bits& number) {
    // The number goes to the top byte; a byte whose highest bit is set gives 0.
    const __m256i index =
        _mm256_or_si256(_mm256_srli_epi32(number.data, 4), _mm256_set1_epi32(0x00808080));
    const auto look_up = [&index](int axis) __attribute__((always_inline)) {
      return Pack(_mm256_castsi256_ps(_mm256_shuffle_epi8(Table(axis), index)));
    };
    return {look_up(0), look_up(1), look_up(2)};
  }
};

namespace {

__m256 LerpEight(__m256 a, __m256 b, __m256 t) {
  return _mm256_add_ps(a, _mm256_mul_ps(t, _mm256_sub_ps(b, a)));
}

// Two corners that are neighbours along x are eight bytes, and eight floats.
void LerpCorners(const std::int8_t* cell, float u, float v, float w, float* four) {
  const __m256 tz = _mm256_set1_ps(w);
  const auto along_z = [&](const std::int8_t* p) {
    const auto widen = [](const std::int8_t* q) {
      return _mm256_cvtepi32_ps(
          _mm256_cvtepi8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(q))));
    };
    return LerpEight(widen(p), widen(p + 16), tz);
  };
  const __m256 both = LerpEight(along_z(cell), along_z(cell + 8), _mm256_set1_ps(v));
  const __m128 low = _mm256_castps256_ps128(both), high = _mm256_extractf128_ps(both, 1);
  _mm_storeu_ps(four, _mm_add_ps(low, _mm_mul_ps(_mm_set1_ps(u), _mm_sub_ps(high, low))));
}

void Columns(const float* rows, xsimd::batch<float, FLOCKLIFT_SWARM_ARCH>* columns) {
  const auto both = [rows](int k) {  // row k in the low half, k + 4 above
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(rows + 4 * k)),
                                _mm_load_ps(rows + 4 * (k + 4)), 1);
  };
  const __m256 a = both(0), b = both(1), c = both(2), d = both(3);
  const __m256 ab = _mm256_unpacklo_ps(a, b), cd = _mm256_unpacklo_ps(c, d);  // 0 0 1 1
  const __m256 ab_high = _mm256_unpackhi_ps(a, b), cd_high = _mm256_unpackhi_ps(c, d);
  columns[0] = _mm256_shuffle_ps(ab, cd, 0x44);
  columns[1] = _mm256_shuffle_ps(ab, cd, 0xEE);
  columns[2] = _mm256_shuffle_ps(ab_high, cd_high, 0x44);
  columns[3] = _mm256_shuffle_ps(ab_high, cd_high, 0xEE);
}

xsimd::batch<std::uint32_t, FLOCKLIFT_SWARM_ARCH> Gather(
    const std::uint8_t* from, const xsimd::batch<std::uint32_t, FLOCKLIFT_SWARM_ARCH>& at) {
  return _mm256_i32gather_epi32(reinterpret_cast<const int*>(from), at.data, 1);
}

void Prefetch(const void* at) { _mm_prefetch(static_cast<const char*>(at), _MM_HINT_T0); }

}  // namespace
}  // namespace flocklift

#include "simulate/flock/kernels/swarm_kernel_inl.h"

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_SWARM_256_INL_H_
