// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/kernels/kernels.h"

namespace flocklift {

const KernelVariant* const kKernels[kKernelVariants] = {&kSse2Kernels, &kAvx2Kernels,
                                                        &kAvx512Kernels};

}  // namespace flocklift
