// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compiled with -mavx512vl; run only where the processor has it. Packs stay 256 bits wide, which
// beat 512 on the processors tried; what counts is that there are 32 registers and that candidates
// are packed by one instruction.

#include <immintrin.h>

#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "simulate/flock/kernels/arch.h"
#include "simulate/flock/kernels/rows_256_inl.h"

FLOCKLIFT_KERNEL_ARCH(Avx512Vl, xsimd::fma3<xsimd::avx2>)

namespace flocklift {
namespace {

std::uint64_t LaneMask(const xsimd::batch_bool<float, Avx512Vl>& lanes) {
  return static_cast<unsigned>(_mm256_movemask_ps(lanes.data));
}

// Writes base + k for every set bit k; may write up to 8 numbers in all.
std::uint32_t AppendSetBits(std::uint64_t mask, std::uint32_t base, std::uint32_t* list) {
  const __m256i numbers = _mm256_add_epi32(_mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7),
                                           _mm256_set1_epi32(static_cast<int>(base)));
  const __m256i packed = _mm256_maskz_compress_epi32(static_cast<__mmask8>(mask), numbers);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(list), packed);
  return static_cast<std::uint32_t>(__builtin_popcountll(mask));
}

// Writes the lanes of the mask's set bits to `to`, one after the other; may write 8 in all.
void StoreSetLanes(std::uint64_t mask, const xsimd::batch<float, Avx512Vl>& from, float* to) {
  _mm256_storeu_ps(to, _mm256_maskz_compress_ps(static_cast<__mmask8>(mask), from.data));
}

[[gnu::always_inline]] inline Vec3<xsimd::batch<float, Avx512Vl>> FetchVectors(
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
  return __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("fma") != 0;
}
}  // namespace

constinit const KernelVariant kAvx512Kernels =
    Kernels<xsimd::batch<float, Avx512Vl>>::Named("avx512", Supported);

}  // namespace flocklift
