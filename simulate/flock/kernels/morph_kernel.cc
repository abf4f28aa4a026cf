// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/kernels/morph_kernel.h"

namespace flocklift {

const MorphKernelVariant kMorphKernels[kMorphKernelVariants] = {
    {"sse2", [] { return true; }, MorphMoveSse2, MorphShapeSse2},
    {"avx2",
     [] { return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0; },
     MorphMoveAvx2, MorphShapeAvx2},
};

}  // namespace flocklift
