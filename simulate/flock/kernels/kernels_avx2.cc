// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compiled with -mavx2 -mfma; run only where the processor has both.

#include <immintrin.h>

#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "simulate/flock/kernels/arch.h"
#include "simulate/flock/kernels/rows_256_inl.h"
#include "simulate/flock/kernels/set_bits_inl.h"

FLOCKLIFT_KERNEL_ARCH(Avx2, xsimd::fma3<xsimd::avx2>)

namespace flocklift {
namespace {

std::uint64_t LaneMask(const xsimd::batch_bool<float, Avx2>& lanes) {
  return static_cast<unsigned>(_mm256_movemask_ps(lanes.data));
}

// Writes base + k for every set bit k; writes 8 numbers in all.
std::uint32_t AppendSetBits(std::uint64_t mask, std::uint32_t base, std::uint32_t* list) {
  const __m128i bytes = _mm_cvtsi64_si128(static_cast<long long>(kSetBits.of[mask]));
  const __m256i numbers =
      _mm256_add_epi32(_mm256_cvtepu8_epi32(bytes), _mm256_set1_epi32(static_cast<int>(base)));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(list), numbers);
  return static_cast<std::uint32_t>(__builtin_popcountll(mask));
}

// Writes the lanes of the mask's set bits to `to`, one after the other; writes 8 in all.
void StoreSetLanes(std::uint64_t mask, const xsimd::batch<float, Avx2>& from, float* to) {
  const __m128i bytes = _mm_cvtsi64_si128(static_cast<long long>(kSetBits.of[mask]));
  _mm256_storeu_ps(to, _mm256_permutevar8x32_ps(from.data, _mm256_cvtepu8_epi32(bytes)));
}

[[gnu::always_inline]] inline Vec3<xsimd::batch<float, Avx2>> FetchVectors(
    const float* rows, const std::uint32_t* places) {
  const EightVectors eight = FetchEight(rows, places);
  return {eight.x, eight.y, eight.z};
}

}  // namespace
}  // namespace flocklift

#include "simulate/flock/kernels/kernels_inl.h"

namespace flocklift {

namespace {
bool Supported() {
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
}
}  // namespace

constinit const KernelVariant kAvx2Kernels =
    Kernels<xsimd::batch<float, Avx2>>::Named("avx2", Supported);

}  // namespace flocklift
