// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <emmintrin.h>

#include <cstddef>
#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "simulate/core/vec3.h"
#include "simulate/flock/kernels/arch.h"

FLOCKLIFT_KERNEL_ARCH(Sse2, xsimd::sse2)

namespace flocklift {
namespace {

std::uint64_t LaneMask(const xsimd::batch_bool<float, Sse2>& lanes) {
  return static_cast<unsigned>(_mm_movemask_ps(lanes.data));
}

// Writes base + k for every set bit k; may write up to 4 numbers beyond.
std::uint32_t AppendSetBits(std::uint64_t mask, std::uint32_t base, std::uint32_t* list) {
  std::uint32_t count = 0;
  for (std::uint32_t k = 0; k < 4; ++k) {
    list[count] = base + k;
    count += static_cast<std::uint32_t>(mask >> k) & 1U;
  }
  return count;
}

// Writes the lanes of the mask's set bits to `to`, one after the other; may write 4 numbers beyond.
void StoreSetLanes(std::uint64_t mask, const xsimd::batch<float, Sse2>& from, float* to) {
  alignas(16) float lanes[4];
  from.store_aligned(lanes);
  std::uint32_t count = 0;
  for (std::uint32_t k = 0; k < 4; ++k) {
    to[count] = lanes[k];
    count += static_cast<std::uint32_t>(mask >> k) & 1U;
  }
}

// Numbers 0, 1 and 2 of the rows places[0 .. 3], which have 8 numbers each.
[[gnu::always_inline]] inline Vec3<xsimd::batch<float, Sse2>> FetchVectors(
    const float* rows, const std::uint32_t* places) {
  const auto row = [&](int n) { return _mm_loadu_ps(rows + std::size_t{8} * places[n]); };
  const __m128 a = row(0), b = row(1), c = row(2), d = row(3);
  const __m128 ab = _mm_unpacklo_ps(a, b), cd = _mm_unpacklo_ps(c, d);  // x x y y
  const __m128 z = _mm_movelh_ps(_mm_unpackhi_ps(a, b), _mm_unpackhi_ps(c, d));
  return {_mm_movelh_ps(ab, cd), _mm_movehl_ps(cd, ab), z};
}

}  // namespace
}  // namespace flocklift

#include "simulate/flock/kernels/kernels_inl.h"

namespace flocklift {

namespace {
bool Supported() { return true; }
}  // namespace

constinit const KernelVariant kSse2Kernels =
    Kernels<xsimd::batch<float, Sse2>>::Named("sse2", Supported);

}  // namespace flocklift
