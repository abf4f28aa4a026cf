// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fits of kernels without a form on flocks whose kernels are known (kernel_case.h):
//   relative L2(rho) error   |phihat r - phi r| / |phi r| in L2(rho), rho of the pairs that were
//                            seen, as in the literature
//   prediction error         max over time of the animals' rms distance between the flights by
//                            phihat and by phi from the same true start, relative to the rms
//                            of the true positions about their mean at the start; mean over runs
//   coverage                 share of rho (where the kernel is known) whose 95 % band has phi in it
//   band over error          rms of the bands' sd over that of the error, both over rho (where
//                            known): 1 where the bands are as wide as the error asks for

#ifndef FLOCKLIFT_TOOLS_KERNEL_TABLE_H_
#define FLOCKLIFT_TOOLS_KERNEL_TABLE_H_

#include <string>
#include <vector>

#include "reconstruct/fit/kernel_fit.h"
#include "tools/kernel_case.h"

namespace flocklift {

struct KernelScore {
  std::string kernel;
  double error = 0;     // relative, L2(rho)
  double coverage = 0;  // of the bands where known
  double width = 0;     // of the bands, over the error
  double known = 0;     // share of rho where known
};

// Of flights from the runs' own starts and from new ones, in the time that the fit saw and after.
struct PredictionScore {
  double seen_time = 0, later_time = 0, new_seen_time = 0, new_later_time = 0;
};

struct KernelRow {
  std::string system;
  double noise = 0;  // sd of each coordinate [m]
  std::vector<KernelScore> kernels;
  PredictionScore prediction;
  double position_noise = 0;  // found
  double seconds = 0;         // CPU
};

std::vector<KernelScore> ScoreKernels(const KernelSystem& system, const KernelFit& fit);
PredictionScore ScorePrediction(const KernelSystem& system, const KernelFit& fit,
                                std::uint64_t seed, int runs);

// Makes the runs of a seed, fits and scores them.
struct KernelTrial {
  KernelFit fit;
  KernelRow row;
};
KernelTrial TryKernels(const KernelSystem& system, const KernelFitOptions& options, double noise,
                       std::uint64_t seed, int predicted_runs, int threads);

// Markdown; rows of one system and noise (other seeds) are averaged.
std::string KernelTable(const std::vector<KernelRow>& rows);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_KERNEL_TABLE_H_
