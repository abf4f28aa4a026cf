// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/kernel_prediction.h"

#include <algorithm>
#include <cmath>

#include "reconstruct/fit/fit_setup.h"
#include "reconstruct/fit/held_out.h"
#include "reconstruct/fit/motion_rows.h"
#include "reconstruct/fit/observed_flock.h"
#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr std::int64_t kFewestRows = 10;  // that a score is told from

struct Sums {
  double product = 0, predicted = 0, observed = 0, straight = 0;
  std::int64_t rows = 0;
};

bool AllMeasured(const ObservedFlock& flock, int animal, int first, int last) {
  for (int f = first; f <= last; ++f) {
    if (!flock.Measured(animal, f)) return false;
  }
  return true;
}

const FittedKernel* Find(const KernelFit& fit, const char* name) {
  for (const FittedKernel& kernel : fit.kernels) {
    if (kernel.name == name) return &kernel;
  }
  return nullptr;
}

class Predictor {
 public:
  Predictor(const KernelFitOptions& options, const KernelFit& fit, int window)
      : order_(options.order),
        reach_(options.reach),
        window_(window),
        attraction_(Find(fit, "attraction")),
        alignment_(Find(fit, "alignment")) {}

  // Window's middle in frame `middle`; what it needs lies in middle - m - 2 .. middle + m + 1, and
  // the state foreseen before that.
  void Add(const ObservedFlock& flock, int middle, Sums* sums) const {
    const int m = window_, ahead = m + 2;
    const ObservedFlock::State state = flock.Foreseen(middle - ahead, 3 * m, ahead);
    for (std::size_t i = 0; i < state.animal.size(); ++i) {
      const int animal = state.animal[i];
      if (!AllMeasured(flock, animal, middle - m - 2, middle + m + 1)) continue;
      const Vec3d& after = flock.Position(animal, middle + m);
      const Vec3d& before = flock.Position(animal, middle - m);
      const double width = m * flock.dt();
      const Vec3d y =
          order_ == 1 ? (after - before) / (2 * width)
                      : (after - 2.0 * flock.Position(animal, middle) + before) / (width * width);
      const Vec3d straight = order_ == 1 ? y - state.velocity[i] : y;
      const Vec3d expected = Drive(state, i);
      sums->product += Dot(y, expected);
      sums->predicted += SquaredNorm(expected);
      sums->observed += SquaredNorm(y);
      sums->straight += SquaredNorm(straight);
      ++sums->rows;
    }
  }

 private:
  Vec3d Drive(const ObservedFlock::State& state, std::size_t i) const {
    Vec3d drive;
    for (std::size_t j = 0; j < state.animal.size(); ++j) {
      if (j == i) continue;
      const Vec3d dx = state.position[j] - state.position[i];
      const double r = Norm(dx);
      if (reach_ > 0 && r > reach_) continue;
      if (attraction_ != nullptr) drive += attraction_->Value(r) * dx;
      if (alignment_ != nullptr) {
        drive += alignment_->Value(r) * (state.velocity[j] - state.velocity[i]);
      }
    }
    return drive;
  }

  int order_;
  double reach_;
  int window_;
  const FittedKernel* attraction_;
  const FittedKernel* alignment_;
};

}  // namespace

std::optional<double> KernelR2(const FitOptions& options, const KernelFitOptions& kernels,
                               const KernelFit& fit, const std::vector<Trajectories>& flocks,
                               const std::vector<int>& splits, double fps) {
  Check(splits.size() == flocks.size(), "one split for each flock");
  std::vector<ObservedFlock> observed;
  int window = std::max(1, options.window);
  std::int64_t points = 0;
  for (const Trajectories& flock : flocks) {
    const ObservedFlock& seen = observed.emplace_back(flock, fps, options.bridged_gap);
    if (options.window == 0) window = std::max(window, ChooseWindow(seen, options.longest_window));
    for (int f = seen.span().first; f <= seen.span().last; ++f) points += seen.Count(f);
  }
  const auto stride = static_cast<int>(
      std::max<std::int64_t>(1, (points + options.max_rows - 1) / options.max_rows));
  const Predictor predictor(kernels, fit, window);
  Sums before, after;
  for (std::size_t k = 0; k < observed.size(); ++k) {
    for (const int middle : Middles(observed[k], window, stride)) {
      if (middle + window + 1 < splits[k]) predictor.Add(observed[k], middle, &before);
      if (middle - window - 1 >= splits[k]) predictor.Add(observed[k], middle, &after);
    }
  }
  if (after.rows < kFewestRows || !(before.predicted > 0) || !(after.straight > 0)) {
    return std::nullopt;
  }
  const double b = before.product / before.predicted;
  const double left = after.observed - 2 * b * after.product + b * b * after.predicted;
  return 1 - left / after.straight;
}

KernelPrediction PredictWithKernels(const FitOptions& options, const KernelFitOptions& kernels,
                                    const std::vector<Trajectories>& flocks, double fps,
                                    std::uint64_t seed, int threads) {
  Check(options.held_out > 0, "a prediction needs time that is held out");
  std::vector<Trajectories> early;
  std::vector<int> splits;
  for (const Trajectories& flock : flocks) {
    splits.push_back(FirstHeldOut(flock, options.held_out));
    early.push_back(BeforeFrame(flock, splits.back()));
  }
  KernelPrediction prediction;
  prediction.fit = FitKernels(kernels, early, fps, seed, threads);
  if (!prediction.fit.IsUsable()) return prediction;
  prediction.r2 = KernelR2(options, kernels, prediction.fit, flocks, splits, fps);
  return prediction;
}

}  // namespace flocklift
