// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/arrow_system.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "simulate/core/rng.h"

namespace flocklift::internal {
namespace {

constexpr int kUnknowns = 27, kOwn = 2, kShared = 3;

// The same residuals, banded with a border and as one dense Jacobian.
struct Both {
  ArrowSystem arrow{kUnknowns, kOwn, kShared};
  Eigen::MatrixXd jacobian{0, kUnknowns + kOwn + kShared};
  Eigen::VectorXd residual{0};

  void Add(const ResidualRow& row, double weight) {
    arrow.Add(row, weight);
    const Eigen::Index last = jacobian.rows();
    jacobian.conservativeResize(last + 1, Eigen::NoChange);
    residual.conservativeResize(last + 1);
    jacobian.row(last).setZero();
    for (int a = 0; a < 12 && row.first + a < kUnknowns; ++a) {
      jacobian(last, row.first + a) = row.path[a];
    }
    for (int a = 0; a < row.border_count; ++a) {
      jacobian(last, kUnknowns + row.border[a].first) += row.border[a].second;
    }
    jacobian.row(last) *= std::sqrt(weight);
    residual[last] = std::sqrt(weight) * row.residual;
  }
};

Both RandomSystem() {
  Both both;
  Rng rng(5);
  for (int k = 0; k < 80; ++k) {
    ResidualRow row;
    row.first = 3 * static_cast<int>(rng.Below(kUnknowns / 3));
    row.residual = rng.Normal();
    for (double& d : row.path) d = rng.Normal();
    row.AddBorder(static_cast<int>(rng.Below(kOwn + kShared)), rng.Normal());
    row.AddBorder(static_cast<int>(rng.Below(kOwn + kShared)), rng.Normal());
    both.Add(row, rng.Uniform(0.5, 2));
  }
  return both;
}

TEST(ArrowSystem, StepIsThatOfTheDenseSystem) {
  Both both = RandomSystem();
  const Eigen::MatrixXd normal = both.jacobian.transpose() * both.jacobian;
  const Eigen::VectorXd gradient = both.jacobian.transpose() * both.residual;
  const Eigen::VectorXd dense = -normal.ldlt().solve(gradient);

  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(kShared, kShared);
  Eigen::VectorXd reduced = Eigen::VectorXd::Zero(kShared);
  ASSERT_TRUE(both.arrow.Reduce(0, &matrix, &reduced));
  const Eigen::VectorXd shared = -matrix.llt().solve(reduced);
  EXPECT_LT((shared - dense.tail(kShared)).norm(), 1e-9 * dense.norm());
  const Eigen::VectorXd own = both.arrow.BackSubstitute(shared);
  EXPECT_LT((own - dense.head(kUnknowns + kOwn)).norm(), 1e-9 * dense.norm());
}

// Damping multiplies the diagonal, but adds to every third unknown, the log depths.
TEST(ArrowSystem, DampingIsMarquardtsAndLevenbergs) {
  Both both = RandomSystem();
  constexpr double kDamping = 0.3;
  Eigen::MatrixXd normal = both.jacobian.transpose() * both.jacobian;
  const Eigen::VectorXd gradient = both.jacobian.transpose() * both.residual;
  for (int i = 0; i < kUnknowns + kOwn; ++i) {
    normal(i, i) +=
        kDamping * (i < kUnknowns && i % 3 == 2 ? ArrowSystem::kDepthMetric : normal(i, i));
  }
  const Eigen::VectorXd dense = -normal.ldlt().solve(gradient);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(kShared, kShared);
  Eigen::VectorXd reduced = Eigen::VectorXd::Zero(kShared);
  ASSERT_TRUE(both.arrow.Reduce(kDamping, &matrix, &reduced));
  const Eigen::VectorXd own = both.arrow.BackSubstitute(-matrix.llt().solve(reduced));
  EXPECT_LT((own - dense.head(kUnknowns + kOwn)).norm(), 1e-9 * dense.norm());
}

TEST(ArrowSystem, CovarianceIsThatOfTheDenseSystem) {
  Both both = RandomSystem();
  const Eigen::MatrixXd dense = (both.jacobian.transpose() * both.jacobian).inverse();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(kShared, kShared);
  Eigen::VectorXd reduced = Eigen::VectorXd::Zero(kShared);
  ASSERT_TRUE(both.arrow.Reduce(0, &matrix, &reduced));
  const Eigen::MatrixXd shared = matrix.inverse();
  EXPECT_LT((shared - dense.bottomRightCorner(kShared, kShared)).norm(), 1e-9 * dense.norm());
  const ArrowSystem::Posterior posterior = both.arrow.Covariance(shared);

  Rng rng(9);
  for (int first : {0, 6, 15, 18}) {  // the last reaches past the end
    ResidualRow row;
    row.first = first;
    for (double& d : row.path) d = rng.Normal();
    row.AddBorder(1, rng.Normal());
    row.AddBorder(3, rng.Normal());
    Eigen::VectorXd j = Eigen::VectorXd::Zero(kUnknowns + kOwn + kShared);
    for (int a = 0; a < 12 && first + a < kUnknowns; ++a) j[first + a] = row.path[a];
    for (int a = 0; a < row.border_count; ++a) {
      j[kUnknowns + row.border[a].first] += row.border[a].second;
    }
    EXPECT_NEAR(both.arrow.VarianceOf(posterior, row), j.dot(dense * j), 1e-9) << first;
  }
}

TEST(ArrowSystem, FunctionalIsThatOfTheDenseSystem) {
  Both both = RandomSystem();
  const Eigen::MatrixXd dense = (both.jacobian.transpose() * both.jacobian).inverse();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(kShared, kShared);
  Eigen::VectorXd reduced = Eigen::VectorXd::Zero(kShared);
  ASSERT_TRUE(both.arrow.Reduce(0, &matrix, &reduced));
  Eigen::VectorXd weights(kUnknowns);
  for (int i = 0; i < kUnknowns; ++i) weights[i] = std::sin(1.0 + i);
  const auto [variance, sensitivity] = both.arrow.Functional(weights);
  const double whole = variance + sensitivity.dot(matrix.inverse() * sensitivity);
  const double expected = weights.dot(dense.topLeftCorner(kUnknowns, kUnknowns) * weights);
  EXPECT_NEAR(whole, expected, 1e-9 * expected);
}

TEST(ArrowSystem, SingularIsSaid) {
  ArrowSystem empty(kUnknowns, kOwn, kShared);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(kShared, kShared);
  Eigen::VectorXd reduced = Eigen::VectorXd::Zero(kShared);
  EXPECT_FALSE(empty.Reduce(0, &matrix, &reduced));
  empty.SetIdentity();
  EXPECT_TRUE(empty.Reduce(0, &matrix, &reduced));
  EXPECT_EQ(empty.BackSubstitute(Eigen::VectorXd::Ones(kShared)).norm(), 0);
}

}  // namespace
}  // namespace flocklift::internal
