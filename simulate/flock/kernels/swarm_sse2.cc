// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <emmintrin.h>

#include <cstddef>
#include <cstdint>
#include <xsimd/xsimd.hpp>

namespace flocklift {
namespace {

__m128 LerpFour(__m128 a, __m128 b, __m128 t) {
  return _mm_add_ps(a, _mm_mul_ps(t, _mm_sub_ps(b, a)));
}

void LerpNodes(const float* node, std::size_t row, std::size_t plane, float u, float v, float w,
               float* out) {
  const __m128 tz = _mm_set1_ps(w), ty = _mm_set1_ps(v);
  const auto along_zy = [&](const float* at) {
    const auto along_z = [&](const float* p) {
      return LerpFour(_mm_loadu_ps(p), _mm_loadu_ps(p + plane), tz);
    };
    return LerpFour(along_z(at), along_z(at + row), ty);
  };
  _mm_storeu_ps(out, LerpFour(along_zy(node), along_zy(node + 4), _mm_set1_ps(u)));
}

}  // namespace
}  // namespace flocklift

#include "simulate/flock/kernels/swarm_kernel_inl.h"

namespace flocklift {

void SwarmKernelSse2(const SwarmJob& job, std::uint32_t first, std::uint32_t last) {
  SwarmVelocities<xsimd::batch<float, xsimd::sse2>>(job, first, last);
}

}  // namespace flocklift
