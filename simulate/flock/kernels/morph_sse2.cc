// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/kernels/arch.h"

FLOCKLIFT_KERNEL_ARCH(Sse2, xsimd::sse2)

namespace flocklift {
namespace {

unsigned LaneMask(const xsimd::batch_bool<float, Sse2>& lanes) {
  return static_cast<unsigned>(_mm_movemask_ps(lanes.data));
}

}  // namespace
}  // namespace flocklift

#include "simulate/flock/kernels/morph_kernel_inl.h"

namespace flocklift {

std::uint32_t MorphMoveSse2(const MorphMoveJob& job, std::uint32_t first, std::uint32_t last,
                            std::uint32_t* events, MorphBox* box) {
  return MorphMove<xsimd::batch<float, Sse2>>(job, first, last, events, box);
}

void MorphShapeSse2(const MorphShapeJob& job, std::uint32_t first, std::uint32_t last) {
  MorphShape<xsimd::batch<float, Sse2>>(job, first, last);
}

}  // namespace flocklift
