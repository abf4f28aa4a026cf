// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// An instruction set of a kernel file's own: xsimd's `BASE` under another name, local to the file,
// so that no function of its packs is shared with files that are compiled with other flags.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_ARCH_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_ARCH_H_

#include <xsimd/xsimd.hpp>

#define FLOCKLIFT_KERNEL_ARCH(NAME, BASE)                   \
  namespace flocklift {                                     \
  namespace {                                               \
  struct NAME : BASE {};                                    \
  }                                                         \
  }                                                         \
  namespace xsimd::types {                                  \
  XSIMD_DECLARE_SIMD_REGISTER_ALIAS(flocklift::NAME, BASE); \
  }

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_ARCH_H_
