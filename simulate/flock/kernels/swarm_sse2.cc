// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <emmintrin.h>

#include <cstdint>
#include <cstring>
#include <utility>
#include <xsimd/xsimd.hpp>

namespace flocklift {
namespace {

__m128 LerpFour(__m128 a, __m128 b, __m128 t) {
  return _mm_add_ps(a, _mm_mul_ps(t, _mm_sub_ps(b, a)));
}

void LerpCorners(const std::int8_t* cell, float u, float v, float w, float* four) {
  const __m128 tz = _mm_set1_ps(w), ty = _mm_set1_ps(v);
  // Sixteen bytes are two rows of two corners; a byte's sign is kept by moving it down from the
  // top.
  const __m128i low = _mm_loadu_si128(reinterpret_cast<const __m128i*>(cell));
  const __m128i high = _mm_loadu_si128(reinterpret_cast<const __m128i*>(cell + 16));
  const auto widen = [](__m128i words) { return _mm_cvtepi32_ps(_mm_srai_epi32(words, 24)); };
  const auto rows = [&](auto unpack_bytes) {
    const __m128i zero = _mm_setzero_si128();
    const __m128i a = unpack_bytes(zero, low), b = unpack_bytes(zero, high);
    const __m128 first =
        LerpFour(widen(_mm_unpacklo_epi16(zero, a)), widen(_mm_unpacklo_epi16(zero, b)), tz);
    const __m128 second =
        LerpFour(widen(_mm_unpackhi_epi16(zero, a)), widen(_mm_unpackhi_epi16(zero, b)), tz);
    return std::pair(first, second);
  };
  const auto near = rows([](__m128i a, __m128i b) { return _mm_unpacklo_epi8(a, b); });
  const auto far = rows([](__m128i a, __m128i b) { return _mm_unpackhi_epi8(a, b); });
  _mm_storeu_ps(four, LerpFour(LerpFour(near.first, far.first, ty),
                               LerpFour(near.second, far.second, ty), _mm_set1_ps(u)));
}

void Columns(const float* rows, xsimd::batch<float, xsimd::sse2>* columns) {
  __m128 a = _mm_load_ps(rows), b = _mm_load_ps(rows + 4), c = _mm_load_ps(rows + 8),
         d = _mm_load_ps(rows + 12);
  _MM_TRANSPOSE4_PS(a, b, c, d);
  columns[0] = a;
  columns[1] = b;
  columns[2] = c;
  columns[3] = d;
}

xsimd::batch<std::uint32_t, xsimd::sse2> Gather(
    const std::uint8_t* from, const xsimd::batch<std::uint32_t, xsimd::sse2>& at) {
  alignas(16) std::uint32_t lanes[4];
  at.store_aligned(lanes);
  for (std::uint32_t& lane : lanes) std::memcpy(&lane, from + lane, sizeof lane);
  return xsimd::batch<std::uint32_t, xsimd::sse2>::load_aligned(lanes);
}

void Prefetch(const void* at) { _mm_prefetch(static_cast<const char*>(at), _MM_HINT_T0); }

}  // namespace
}  // namespace flocklift

#include "simulate/flock/kernels/swarm_kernel_inl.h"

namespace flocklift {

void SwarmKernelSse2(const SwarmJob& job, std::uint32_t first, std::uint32_t last) {
  SwarmVelocities<xsimd::batch<float, xsimd::sse2>>(job, first, last);
}

void CellKernelSse2(const CellJob& job, std::uint32_t first, std::uint32_t last) {
  CellNumbers<xsimd::batch<float, xsimd::sse2>>(job, first, last);
}

std::uint32_t CompanyKernelSse2(const CompanyJob& job, std::uint32_t first, std::uint32_t last,
                                std::uint32_t* found, std::uint32_t* lowest) {
  return FindCompany<xsimd::batch<float, xsimd::sse2>>(job, first, last, found, lowest);
}

std::uint32_t NearKernelSse2(const NearJob& job, std::uint32_t first, std::uint32_t last,
                             std::uint32_t* found) {
  return FindNear<xsimd::batch<float, xsimd::sse2>>(job, first, last, found);
}

std::uint32_t CloseKernelSse2(const CloseJob& job, std::uint32_t first, std::uint32_t last,
                              std::uint32_t* found) {
  return FindClose<xsimd::batch<float, xsimd::sse2>>(job, first, last, found);
}

}  // namespace flocklift
