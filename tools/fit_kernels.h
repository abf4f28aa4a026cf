// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// `flocklift fit --model kernels`: interaction kernels without a form, of one or more films of a
// flock.

#ifndef FLOCKLIFT_TOOLS_FIT_KERNELS_H_
#define FLOCKLIFT_TOOLS_FIT_KERNELS_H_

#include "tools/fit_command.h"

namespace flocklift {

// Writes kernels.csv and kernels.svg. Throws CannotFit, with nothing written, and for options that
// kernels have no use for std::invalid_argument.
void RunKernelFit(const FitCommand& command, const CommonOptions& common);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_FIT_KERNELS_H_
