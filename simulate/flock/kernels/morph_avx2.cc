// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compiled with -mavx2 -mfma; run only where the processor has both.

#include "simulate/flock/kernels/arch.h"

FLOCKLIFT_KERNEL_ARCH(Avx2, xsimd::fma3<xsimd::avx2>)

namespace flocklift {
namespace {

unsigned LaneMask(const xsimd::batch_bool<float, Avx2>& lanes) {
  return static_cast<unsigned>(_mm256_movemask_ps(lanes.data));
}

}  // namespace
}  // namespace flocklift

#include "simulate/flock/kernels/morph_kernel_inl.h"

namespace flocklift {

std::uint32_t MorphMoveAvx2(const MorphMoveJob& job, std::uint32_t first, std::uint32_t last,
                            std::uint32_t* events, MorphBox* box) {
  return MorphMove<xsimd::batch<float, Avx2>>(job, first, last, events, box);
}

void MorphShapeAvx2(const MorphShapeJob& job, std::uint32_t first, std::uint32_t last) {
  MorphShape<xsimd::batch<float, Avx2>>(job, first, last);
}

}  // namespace flocklift
