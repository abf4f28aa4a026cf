// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/kernel_prediction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/reconstruct/fit/kernel_flock.h"

namespace flocklift {
namespace {

constexpr int kSplit = 49;

// A fit whose one kernel is `value` at all distances.
KernelFit Constant(const char* name, double value) {
  FittedKernel kernel;
  kernel.name = name;
  kernel.basis = SplineBasis({0, 100}, 0);
  kernel.coefficients = {value};
  KernelFit fit;
  fit.kernels = {kernel};
  return fit;
}

KernelFlock Springs(int order) {
  return {.order = order, .animals = 5, .attraction = [](double) { return 0.2; }, .alignment = {}};
}

std::optional<double> R2(int order, const KernelFit& fit, const Trajectories& flight) {
  return KernelR2({}, {.order = order}, fit, {flight}, {kSplit}, *flight.fps);
}

TEST(KernelPrediction, TheTrueKernelForeseesWhatHasNoNoise) {
  for (const int order : {1, 2}) {
    const Trajectories flight = FlyKernels(Springs(order), 1);
    const std::optional<double> r2 = R2(order, Constant("attraction", 0.2), flight);
    ASSERT_TRUE(r2.has_value());
    EXPECT_GT(*r2, 0.95) << order;
    EXPECT_LT(*r2, 1) << order;
    // The noise of the states foreseen is made up for by a factor: so is a wrong scale.
    EXPECT_NEAR(*R2(order, Constant("attraction", 0.4), flight), *r2, 1e-9) << order;
  }
}

// Two animals on a line, x = -+ (1 + t^2 / 2): each accelerates by 1 for ever. The pull of a kernel
// of 1 on the first is 2 + t^2 towards the other, so that by hand yhat and b follow.
TEST(KernelPrediction, IsWhatOneCountsByHand) {
  Trajectories flight;
  flight.fps = 10;
  for (const int id : {1, 2}) {
    Trajectory& trajectory = flight.trajectories.emplace_back();
    trajectory.id = id;
    for (int frame = 1; frame <= 60; ++frame) {
      const double t = 0.1 * (frame - 1);
      TrajectoryPoint point;
      point.frame = frame;
      point.position.x = (id == 1 ? -1 : 1) * (1 + t * t / 2);
      trajectory.points.push_back(point);
    }
  }
  FitOptions options;
  options.window = 2;
  const std::optional<double> r2 =
      KernelR2(options, {.order = 2}, Constant("attraction", 1), {flight}, {kSplit}, 10);
  // Windows lie between frames f - 4 and f + 3, states are foreseen from frames up to f - 4 by
  // parabolas, which are exact; two frames of past at least.
  double product = 0, predicted = 0, later_product = 0, later_predicted = 0, observed = 0;
  for (int frame = 6; frame <= 57; ++frame) {
    const double t = 0.1 * (frame - 1);
    // From two frames only, a straight line.
    const double past = 0.1 * (frame - 5);
    const double x = frame == 6
                         ? 1 + past * past / 2 + 4 * (past * past - (past - 0.1) * (past - 0.1)) / 2
                         : 1 + t * t / 2;
    const double expected = -2 * x;  // where y = 1
    if (frame + 3 < kSplit) {
      product += expected;
      predicted += expected * expected;
    }
    if (frame - 3 >= kSplit) {
      later_product += expected;
      later_predicted += expected * expected;
      observed += 1;
    }
  }
  const double b = product / predicted;
  ASSERT_TRUE(r2.has_value());
  EXPECT_NEAR(*r2, (2 * b * later_product - b * b * later_predicted) / observed, 1e-9);
}

TEST(KernelPrediction, AlignmentTurnsTheVelocitiesForeseen) {
  KernelFlock flock = Springs(2);
  flock.attraction = [](double) { return 0.0; };
  flock.alignment = [](double) { return 0.3; };
  const Trajectories flight = FlyKernels(flock, 2);
  EXPECT_GT(*R2(2, Constant("alignment", 0.3), flight), 0.95);
  EXPECT_LT(*R2(2, Constant("attraction", 0.3), flight), 0.5);
}

TEST(KernelPrediction, FitsOnlyWhatComesBefore) {
  const Trajectories flight = FlyKernels(Springs(2), 3);
  Trajectories later_is_mad = flight;
  for (Trajectory& trajectory : later_is_mad.trajectories) {
    for (TrajectoryPoint& point : trajectory.points) {
      if (point.frame >= kSplit) point.position.y += std::cos(0.9 * point.frame * trajectory.id);
    }
  }
  FitOptions options;
  options.window = 1;
  const KernelFitOptions kernels{.order = 2, .intervals = 6};
  const KernelPrediction is = PredictWithKernels(options, kernels, {flight}, *flight.fps, 1, 2);
  const KernelPrediction mad =
      PredictWithKernels(options, kernels, {later_is_mad}, *flight.fps, 1, 1);
  ASSERT_TRUE(is.r2 && mad.r2);
  EXPECT_EQ(is.fit.kernels[0].coefficients, mad.fit.kernels[0].coefficients);
  EXPECT_GT(*is.r2, 0.9);
  EXPECT_LT(*mad.r2, 0.5);
}

TEST(KernelPrediction, SaysWhenThereIsTooLittle) {
  KernelFlock brief = Springs(2);
  brief.frames = 16;
  const Trajectories flight = FlyKernels(brief, 1);
  const KernelPrediction prediction =
      PredictWithKernels({}, {.order = 2, .intervals = 4}, {flight}, *flight.fps, 1, 1);
  EXPECT_FALSE(prediction.r2.has_value());
  FitOptions options;
  options.held_out = 0;
  EXPECT_THROW(PredictWithKernels(options, {}, {flight}, *flight.fps, 1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
