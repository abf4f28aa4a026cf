// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How well kernels fitted to the first part of the time foresee the last, as fit_measures.h has it
// for models with parameters:
//   R^2 = 1 - sum |y - b yhat|^2 / sum |y - y0|^2     over windows after `split`
// order 2: y the second difference over +- m frames, yhat the accelerations that the kernels expect
// of the state foreseen from frames before the window, y0 = 0; order 1: y the mean velocity over
// the window, yhat likewise, y0 the velocity foreseen. 0 is constant velocity in both. b, from
// before `split`, makes up for the noise of the states foreseen.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_PREDICTION_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_PREDICTION_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "reconstruct/fit/fit.h"
#include "reconstruct/fit/kernel_fit.h"

namespace flocklift {

struct KernelPrediction {
  KernelFit fit;             // of the first part of the time
  std::optional<double> r2;  // absent when there is too little to tell
};

// Of `options`: held_out (above 0), window, longest_window, max_rows. The last part of each flock's
// own time is held out.
KernelPrediction PredictWithKernels(const FitOptions& options, const KernelFitOptions& kernels,
                                    const std::vector<Trajectories>& flocks, double fps,
                                    std::uint64_t seed, int threads);

// As `fit` would predict, from frame `split` of each flock on; frames before it give b.
std::optional<double> KernelR2(const FitOptions& options, const KernelFitOptions& kernels,
                               const KernelFit& fit, const std::vector<Trajectories>& flocks,
                               const std::vector<int>& splits, double fps);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_PREDICTION_H_
