// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/kernels/boids_kernel.h"

namespace flocklift {

const BoidsKernelVariant kBoidsKernels[kBoidsKernelVariants] = {
    {"sse2", [] { return true; }, BoidsKernelSse2, MoveKernelSse2},
    {"avx2",
     [] { return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0; },
     BoidsKernelAvx2, MoveKernelAvx2},
    {"avx512",
     [] { return __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("fma") != 0; },
     BoidsKernelAvx512, MoveKernelAvx512},
};

}  // namespace flocklift
