// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How far kernels fitted as splines are from what splines on these breaks cannot follow (a kink, a
// step), told from coarser fits of the same equations, as integrals are from half as many points.
// With f_0 the fit, f_1 that on every other break and f_2 that on every fourth,
//   d_l = f_l - f_{l+1}       what the breaks left out have moved
//   g = |d_0| / |d_1|         what is left of an error where intervals are halved
//   misfit = |d_0| g / (1 - g), |d_0| where g > 1/2
// the sum of all further such steps, if each leaves the same share (Aitken's extrapolation); what
// would be beyond |d_0| itself is not believed. |.| is the rms, over the pairs, in the interval of
// the coarser fit and those beside it: differences change sign from one to the next, and where
// there are no pairs they mean nothing.
//
// The spaces are nested: with T the coarser splines in terms of the finer, T'HT c = T'r are the
// coarser fit's equations, noise and smoothness being the finer one's, and nothing is gathered
// anew. Differences of noise alone have the variance V_l - V_{l+1} at most, V_l = T (T'HT)^-1 T'
// (Hausman, "Specification tests in econometrics", 1978): this is taken off d^2, so that bands
// that noise makes are left as they are.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_MISFIT_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_MISFIT_H_

#include <Eigen/Core>
#include <vector>

#include "reconstruct/fit/kernel_breaks.h"
#include "reconstruct/fit/spline_basis.h"

namespace flocklift {

// Of kernels whose coefficients, one kernel's after the other's, are H^-1 r: for each kernel the
// misfit in every interval between its breaks, as an sd [the kernel's unit].
std::vector<std::vector<double>> KernelMisfits(const std::vector<SplineBasis>& kernels,
                                               const PairDensity& pairs, const Eigen::MatrixXd& h,
                                               const Eigen::VectorXd& r);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_MISFIT_H_
