// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fitted kernels as a file of their own: each with its 95 % band, dashed where it is not known,
// over the density of the pairs.

#ifndef FLOCKLIFT_TOOLS_KERNEL_PICTURE_H_
#define FLOCKLIFT_TOOLS_KERNEL_PICTURE_H_

#include <functional>
#include <string>
#include <vector>

#include "reconstruct/fit/kernel_fit.h"

namespace flocklift {

// SVG. `truths`, where given, are drawn beside: one for each kernel, empty functions for none.
std::string KernelsPicture(const std::vector<FittedKernel>& kernels, int order,
                           const std::vector<std::function<double(double)>>& truths = {});

// CSV with a line of units and a header: kernel,distance,value,sd,low,high,density,known; low and
// high bound 95 %.
std::string KernelsTable(const std::vector<FittedKernel>& kernels, int order);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_KERNEL_PICTURE_H_
