// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <emmintrin.h>

#include <cstdint>
#include <xsimd/xsimd.hpp>

namespace flocklift {
namespace {

std::uint64_t LaneMask(const xsimd::batch_bool<float, xsimd::sse2>& lanes) {
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

}  // namespace
}  // namespace flocklift

#include "simulate/flock/kernels/boids_kernel_inl.h"

namespace flocklift {

void BoidsKernelSse2(const BoidsJob& job, int first_row, int last_row, std::uint32_t* candidates) {
  BoidsRows<xsimd::batch<float, xsimd::sse2>>(job, first_row, last_row, candidates);
}

void MoveKernelSse2(const MoveJob& job, std::uint32_t first, std::uint32_t last) {
  Move<xsimd::batch<float, xsimd::sse2>>(job, first, last);
}

}  // namespace flocklift
