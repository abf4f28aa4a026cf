// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/time_system.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>

#include "simulate/core/rng.h"

namespace flocklift::internal {
namespace {

// A random system of residuals over four times and the border, and the same as one dense matrix.
struct Twin {
  std::vector<int> widths = {3, 6, 6, 9, 6, 3, 6};
  int border = 4;
  TimeSystem system{widths, border};
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;

  int At(int time) const { return std::accumulate(widths.begin(), widths.begin() + time, 0); }
  int size() const { return At(static_cast<int>(widths.size())); }

  Twin() {
    Rng rng(2);
    const int n = size() + border;
    matrix = Eigen::MatrixXd::Zero(n, n);
    gradient = Eigen::VectorXd::Zero(n);
    for (int trial = 0; trial < 300; ++trial) {
      const int first = trial % static_cast<int>(widths.size());
      const int last = std::min<int>(first + TimeSystem::kSpan, static_cast<int>(widths.size()));
      Eigen::VectorXd row = Eigen::VectorXd::Zero(n);
      for (int i = At(first); i < At(last); ++i) row[i] = rng.Normal();
      for (double& x : row.tail(border)) x = rng.Normal();
      matrix += row * row.transpose();
      gradient += rng.Normal() * row;
    }
    for (int t = 0; t < system.times(); ++t) {
      for (int d = 0; d < TimeSystem::kSpan && d <= t; ++d) {
        system.Block(t, d) = matrix.block(At(t), At(t - d), system.width(t), system.width(t - d));
      }
      system.ToBorder(t) = matrix.block(At(t), size(), system.width(t), border);
      system.Gradient(t) = gradient.segment(At(t), system.width(t));
    }
    system.Corner() = matrix.bottomRightCorner(border, border);
    system.BorderGradient() = gradient.tail(border);
  }
};

TEST(TimeSystem, StepIsThatOfTheDenseSystem) {
  for (const double damping : {0.0, 0.5}) {
    Twin twin;
    constexpr double kMetric = 7;
    Eigen::MatrixXd damped = twin.matrix;
    for (int t = 0; t < twin.system.times(); ++t) {
      for (int k = 0; k < twin.system.width(t); ++k) {
        double& entry = damped(twin.At(t) + k, twin.At(t) + k);
        entry += damping * (k % 3 == 2 ? kMetric : entry);
      }
    }
    damped.diagonal().tail(twin.border) *= 1 + damping;
    const Eigen::VectorXd expected = -damped.llt().solve(twin.gradient);
    ASSERT_TRUE(twin.system.Factorise(damping, kMetric));
    const TimeSystem::Step step = twin.system.Solve();
    for (int t = 0; t < twin.system.times(); ++t) {
      EXPECT_NEAR((step.at[static_cast<std::size_t>(t)] -
                   expected.segment(twin.At(t), twin.system.width(t)))
                      .norm(),
                  0, 1e-10);
    }
    EXPECT_NEAR((step.border - expected.tail(twin.border)).norm(), 0, 1e-10);
  }
}

TEST(TimeSystem, CovarianceIsThatOfTheDenseSystem) {
  Twin twin;
  ASSERT_TRUE(twin.system.Factorise(0, 0));
  const TimeSystem::Posterior posterior = twin.system.Covariance();
  const Eigen::MatrixXd inverse = twin.matrix.inverse();
  const int n = twin.size();
  EXPECT_NEAR((posterior.border - inverse.bottomRightCorner(twin.border, twin.border)).norm(), 0,
              1e-10);
  const auto at = [](int t) { return static_cast<std::size_t>(t); };
  for (int t = 0; t < twin.system.times(); ++t) {
    for (int d = 0; d < TimeSystem::kSpan && d <= t; ++d) {
      const Eigen::MatrixXd found =
          posterior.band[at(t)][at(d)] + posterior.to_border[at(t)] * posterior.border *
                                             posterior.to_border[at(t - d)].transpose();
      const Eigen::MatrixXd expected =
          inverse.block(twin.At(t), twin.At(t - d), twin.system.width(t), twin.system.width(t - d));
      EXPECT_NEAR((found - expected).norm(), 0, 1e-10) << t << " " << d;
    }
    const Eigen::MatrixXd across = -posterior.to_border[at(t)] * posterior.border;
    EXPECT_NEAR((across - inverse.block(twin.At(t), n, twin.system.width(t), twin.border)).norm(),
                0, 1e-10);
  }
  std::vector<Eigen::VectorXd> weights;
  Eigen::VectorXd all = Eigen::VectorXd::Zero(n + twin.border);
  Rng rng(8);
  for (int t = 0; t < twin.system.times(); ++t) {
    Eigen::VectorXd& part = weights.emplace_back(twin.system.width(t));
    for (double& x : part) x = rng.Normal();
    all.segment(twin.At(t), part.size()) = part;
  }
  EXPECT_NEAR(twin.system.Variance(weights), all.dot(inverse * all), 1e-9);
}

TEST(TimeSystem, SaysWhenItIsNotPositive) {
  Twin twin;
  twin.system.Block(3, 0)(1, 1) = -1;
  EXPECT_FALSE(twin.system.Factorise(0, 0));
}

}  // namespace
}  // namespace flocklift::internal
