// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compiled with -mavx512vl; run only where the processor has it.

#include "simulate/flock/kernels/arch.h"

FLOCKLIFT_KERNEL_ARCH(Avx512Vl, xsimd::fma3<xsimd::avx2>)
#define FLOCKLIFT_SWARM_ARCH Avx512Vl
#include "simulate/flock/kernels/swarm_256_inl.h"

namespace flocklift {

void SwarmKernelAvx512(const SwarmJob& job, std::uint32_t first, std::uint32_t last) {
  SwarmVelocities<xsimd::batch<float, Avx512Vl>>(job, first, last);
}

void CellKernelAvx512(const CellJob& job, std::uint32_t first, std::uint32_t last) {
  CellNumbers<xsimd::batch<float, Avx512Vl>>(job, first, last);
}

std::uint32_t CompanyKernelAvx512(const CompanyJob& job, std::uint32_t first, std::uint32_t last,
                                  std::uint32_t* found, std::uint32_t* lowest) {
  return FindCompany<xsimd::batch<float, Avx512Vl>>(job, first, last, found, lowest);
}

std::uint32_t NearKernelAvx512(const NearJob& job, std::uint32_t first, std::uint32_t last,
                               std::uint32_t* found) {
  return FindNear<xsimd::batch<float, Avx512Vl>>(job, first, last, found);
}

std::uint32_t CloseKernelAvx512(const CloseJob& job, std::uint32_t first, std::uint32_t last,
                                std::uint32_t* found) {
  return FindClose<xsimd::batch<float, Avx512Vl>>(job, first, last, found);
}

}  // namespace flocklift
