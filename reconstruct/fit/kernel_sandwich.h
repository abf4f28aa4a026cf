// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Covariance of kernels' coefficients where rows of one flight err together, as they do where it is
// not noise that is left (Liang and Zeger, "Longitudinal data analysis using generalized linear
// models", Biometrika 1986): of flights f with the scores g_f = X_f' W (y_f - X_f c),
//   V_g = n / (n - 1) V sum_f (g_f - g)(g_f - g)' V,   g their mean
// The mean takes off what penalties, and noise that is felt (kernel_modes.h), make of all alike.
// Where rows are independent V_g scatters about V; the larger of both in every direction of V is
// taken, V' = L max(1, L^-1 V_g L^-T) L', V = L L'; by chance alone this adds V at most in the
// mean.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_SANDWICH_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_SANDWICH_H_

#include <Eigen/Core>
#include <map>
#include <vector>

#include "reconstruct/fit/kernel_evidence.h"
#include "reconstruct/fit/kernel_moments.h"

namespace flocklift {

// V' of a fit to `flocks`, each of which is a flight; `modes` by run length. Of one flock: V. Not
// for fits to moments that noise has been taken out of: these scores are the plain moments'. Same
// bytes at any number of threads.
Eigen::MatrixXd KernelSandwich(const KernelDesign& design, const std::vector<ObservedFlock>& flocks,
                               const std::map<int, KernelModes>& modes,
                               const KernelEvidence& evidence, int threads);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_SANDWICH_H_
