// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How rough kernels are, as kernel_evidence.h weighs it: integrals of (phi'')^2 under hats over the
// breaks, each with a smoothness of its own, in units of the breaks' distances, so that closer
// breaks allow more bending.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_PENALTIES_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_PENALTIES_H_

#include "reconstruct/fit/kernel_evidence.h"
#include "reconstruct/fit/kernel_moments.h"

namespace flocklift {

// Of all kernels of the design, by its terms.
KernelPenalties SmoothnessOf(const KernelDesign& design);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_PENALTIES_H_
