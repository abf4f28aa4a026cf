// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compiled with -mavx2 -mfma; run only where the processor has both.

#include "simulate/flock/kernels/arch.h"

FLOCKLIFT_KERNEL_ARCH(Avx2, xsimd::fma3<xsimd::avx2>)
#define FLOCKLIFT_SWARM_ARCH Avx2
#include "simulate/flock/kernels/swarm_256_inl.h"

namespace flocklift {

void SwarmKernelAvx2(const SwarmJob& job, std::uint32_t first, std::uint32_t last) {
  SwarmVelocities<xsimd::batch<float, Avx2>>(job, first, last);
}

void CellKernelAvx2(const CellJob& job, std::uint32_t first, std::uint32_t last) {
  CellNumbers<xsimd::batch<float, Avx2>>(job, first, last);
}

std::uint32_t CompanyKernelAvx2(const CompanyJob& job, std::uint32_t first, std::uint32_t last,
                                std::uint32_t* found, std::uint32_t* lowest) {
  return FindCompany<xsimd::batch<float, Avx2>>(job, first, last, found, lowest);
}

std::uint32_t NearKernelAvx2(const NearJob& job, std::uint32_t first, std::uint32_t last,
                             std::uint32_t* found) {
  return FindNear<xsimd::batch<float, Avx2>>(job, first, last, found);
}

std::uint32_t CloseKernelAvx2(const CloseJob& job, std::uint32_t first, std::uint32_t last,
                              std::uint32_t* found) {
  return FindClose<xsimd::batch<float, Avx2>>(job, first, last, found);
}

}  // namespace flocklift
