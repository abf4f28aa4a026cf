// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/fitter.h"

#include <algorithm>
#include <cmath>

#include "reconstruct/fit/depth_noise.h"
#include "reconstruct/fit/fit_measures.h"

namespace flocklift::internal {
namespace {

// ... and when one more depth error of the stated size changes it, and its term, by less than this.
constexpr double kDepthShare = 0.5;

}  // namespace

std::optional<DepthErrors> Fitter::StatedDepthErrors() const {
  if (!trajectories_.has_sd_depth) return std::nullopt;
  const auto share = [this](int animal, int frame) {
    return DepthShareOf(problem_.camera, frame, flock_.Position(animal, frame),
                        flock_.SdDepth(animal, frame), options_.scale_sd);
  };
  return DepthErrors{.sight = [=](int animal, int frame) { return share(animal, frame).sight; },
                     .own = [=](int animal, int frame) { return share(animal, frame).own; },
                     .scale_sd = options_.scale_sd,
                     .time = options_.depth_error_time};
}

void Fitter::AddDepthFactors(const WhitenedFit& fit) {
  const std::size_t p = terms_.free.size();
  std::vector<double> sums(p), squares(p), shares(p);
  int draws = 0;
  for (int draw = 0; draw < options_.depth_draws; ++draw) {
    const DepthNoiseOptions noise{.time = options_.depth_error_time,
                                  .scale_sd = options_.scale_sd,
                                  .seed = seed_,
                                  .draw = static_cast<std::uint32_t>(draw)};
    const Trajectories noisy = AddDepthNoise(noise, problem_.camera, fps_, trajectories_);
    const MotionRows noisy_rows = Rows(ObservedFlock(noisy, fps_, options_.bridged_gap), {});
    const std::vector<double> changed = ChangedShares(rows_, noisy_rows);
    const bool shares_only = result_.method == FitMethod::kStateSpace;
    const WhitenedFit again = shares_only ? fit : SolveWhitened(whitening_, noisy_rows);
    if (!again.IsUsable()) continue;
    ++draws;
    for (std::size_t c = 0; c < p; ++c) {
      shares[c] += changed[c];
      const double factor = again.regression.estimate[c] / fit.regression.estimate[c];
      sums[c] += factor;
      squares[c] += factor * factor;
    }
  }
  if (draws < 2) return;
  for (std::size_t c = 0; c < p; ++c) {
    FittedWeight& weight = result_.weights[c];
    const double mean = sums[c] / draws;
    weight.depth_share = shares[c] / draws;
    if (result_.method == FitMethod::kStateSpace) {
      weight.determined = weight.determined && *weight.depth_share < kDepthShare;
      continue;
    }
    if (!weight.determined || !std::isfinite(mean)) continue;
    weight.depth_factor = mean;
    weight.depth_factor_sd =
        std::sqrt(std::max(0.0, squares[c] / draws - mean * mean) / (draws - 1));
    weight.determined = std::abs(mean - 1) < kDepthShare && *weight.depth_share < kDepthShare;
  }
}

}  // namespace flocklift::internal
