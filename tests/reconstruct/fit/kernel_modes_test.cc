// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/kernel_modes.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

constexpr double kDt = 0.1;

TEST(KernelModes, PositionNoiseIsIndependentInThem) {
  for (const int order : {1, 2}) {
    const KernelModes modes = MakeKernelModes(order, 12, kDt);
    EXPECT_EQ(modes.modes(), 12 - order);
    const Eigen::MatrixXd covariance = modes.difference * modes.difference.transpose();
    const Eigen::MatrixXd expected = modes.lambda.asDiagonal();
    EXPECT_LT((covariance - expected).norm(), 1e-9 * expected.norm());
    // And they know nothing of a place (and a velocity).
    for (int power = 0; power < order; ++power) {
      const Eigen::VectorXd still =
          Eigen::ArrayXd::LinSpaced(12, 0, 1).pow(static_cast<double>(power)).matrix();
      EXPECT_LT((modes.difference * still).norm(), 1e-9 * modes.difference.norm());
    }
  }
}

// Process noise by brute force: many paths of fine steps.
TEST(KernelModes, ProcessNoiseHasUnitVarianceInThem) {
  constexpr int kFrames = 7, kFine = 16, kPaths = 4000;
  for (const int order : {1, 2}) {
    const KernelModes modes = MakeKernelModes(order, kFrames, kDt);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(modes.modes(), modes.modes());
    for (int path = 0; path < kPaths; ++path) {
      Rng rng(static_cast<std::uint64_t>(order), static_cast<std::uint64_t>(path));
      Eigen::VectorXd x = Eigen::VectorXd::Zero(kFrames);
      double at = 0, v = 0;
      const double h = kDt / kFine, kick = std::sqrt(2 * h);
      for (int k = 1; k < kFrames; ++k) {
        for (int step = 0; step < kFine; ++step) {
          const double change = kick * rng.Normal();
          if (order == 1) {
            at += change;
          } else {
            at += h * (v + 0.5 * change);
            v += change;
          }
        }
        x[k] = at;
      }
      const Eigen::VectorXd row = modes.difference * x;
      sum += row * row.transpose() / kPaths;
    }
    EXPECT_LT((sum - Eigen::MatrixXd::Identity(modes.modes(), modes.modes())).cwiseAbs().maxCoeff(),
              0.12)
        << order;
  }
}

TEST(KernelModes, QuadratureIntegratesSmoothMotion) {
  // f = t^2: x of order 1 t^3 / 3, of order 2 t^4 / 12; the ends of order 2 are of lower order.
  constexpr int kFrames = 9;
  Eigen::VectorXd f(kFrames), x1(kFrames), x2(kFrames);
  for (int k = 0; k < kFrames; ++k) {
    const double t = kDt * k;
    f[k] = t * t;
    x1[k] = t * t * t / 3;
    x2[k] = t * t * t * t / 12;
  }
  const Eigen::VectorXd first = KernelQuadrature(1, kFrames, kDt) * f;
  const Eigen::VectorXd second = KernelQuadrature(2, kFrames, kDt) * f;
  for (int k = 0; k + 1 < kFrames; ++k) EXPECT_NEAR(first[k], x1[k + 1] - x1[k], 1e-15);
  for (int k = 1; k + 3 < kFrames; ++k) {
    EXPECT_NEAR(second[k], x2[k + 2] - 2 * x2[k + 1] + x2[k], 1e-15);
  }
  EXPECT_NEAR(second[0], x2[2] - 2 * x2[1] + x2[0], kDt * kDt * kDt * kDt);
}

TEST(KernelModes, WithoutPositionNoiseKappaIsTheWeightOfWhatHasPassed) {
  const int frames = 10;
  const KernelModes modes = MakeKernelModes(1, frames, kDt);
  const Eigen::MatrixXd q = KernelQuadrature(1, frames, kDt);
  const double diffusion = 0.3;
  const Eigen::VectorXd kappa = modes.Kappa(0, diffusion).col(0);
  for (int m = 0; m < frames; ++m) {
    // Increment k ends at frame k + 1: the state at m has felt those with k < m.
    EXPECT_NEAR(diffusion * kappa[m], q.col(m).head(m).sum(), 1e-12);
  }
}

// By brute force: noise in fine steps through a velocity (order 1: a position) that forgets it.
TEST(KernelModes, WhatIsFeltIsForgotten) {
  constexpr int kFrames = 7, kFine = 200;
  const double h = kDt / kFine;
  for (const double rate : {0.0, 4.0}) {
    for (const int order : {1, 2}) {
      const Eigen::MatrixXd felt = KernelSharedNoise(order, kFrames, kDt, rate);
      Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(felt.rows(), kFrames);
      for (int step = -kFine; step < kFrames * kFine; ++step) {
        const double s = h * (step + 0.5);  // when the kick comes
        for (int m = 0; m < kFrames; ++m) {
          const double t = kDt * m;
          double state = s < t ? std::exp(-rate * (t - s)) : 0;
          if (order == 2) {  // the mean of the velocity over the frames beside
            const double from = std::max(s, t - kDt), to = t + kDt;
            const auto until = [&](double at) {
              return rate > 0 ? -std::exp(-rate * (at - s)) / rate : at;
            };
            state = to > from ? (until(to) - until(from)) / (2 * kDt) : 0;
          }
          for (Eigen::Index k = 0; k < felt.rows(); ++k) {
            const double at = kDt * static_cast<double>(k);
            const double row = order == 1 ? (s > at && s < at + kDt ? 1 : 0)
                                          : std::max(0.0, kDt - std::abs(s - at - kDt));
            sum(k, m) += 2 * h * row * state;
          }
        }
      }
      EXPECT_LT((sum - felt).cwiseAbs().maxCoeff(), 5e-3 * felt.maxCoeff()) << order << " " << rate;
    }
  }
  EXPECT_THROW(KernelSharedNoise(2, kFrames, kDt, -1), std::invalid_argument);
}

TEST(KernelModes, RefusesShortRunsAndOtherOrders) {
  EXPECT_THROW(MakeKernelModes(1, 3, kDt), std::invalid_argument);
  EXPECT_THROW(MakeKernelModes(2, 4, kDt), std::invalid_argument);
  EXPECT_THROW(MakeKernelModes(3, 9, kDt), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
