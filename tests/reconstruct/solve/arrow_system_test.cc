// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/arrow_system.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "simulate/core/rng.h"

namespace flocklift::internal {
namespace {

// The path is longer than what is eliminated at once.
constexpr int kUnknowns = 111, kOwn = 2, kShared = 3;

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

// The path meets one of the flock's unknowns late and leaves another soon.
bool Meets(int first, int border) {
  return border == kOwn ? first >= 60 : border == kOwn + 1 ? first < 30 : true;
}

Both RandomSystem() {
  Both both;
  Rng rng(5);
  for (int k = 0; k < 300; ++k) {
    ResidualRow row;
    row.first = 3 * static_cast<int>(rng.Below(kUnknowns / 3));
    row.residual = rng.Normal();
    for (double& d : row.path) d = rng.Normal();
    for (int n = 0; n < 2; ++n) {
      const int border = static_cast<int>(rng.Below(kOwn + kShared));
      if (Meets(row.first, border)) row.AddBorder(border, rng.Normal());
    }
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

// The same step, from the parts that take other right-hand sides, and several of these at once.
TEST(ArrowSystem, MultipliesAndSolvesAnyRightHandSide) {
  Both both = RandomSystem();
  const Eigen::MatrixXd normal = both.jacobian.transpose() * both.jacobian;
  Rng rng(8);
  Columns<8> x(normal.rows(), 8);
  for (double& v : x.reshaped()) v = rng.Normal();
  const Columns<8> expected = normal * x;

  Columns<8> y = Columns<8>::Zero(kUnknowns + kOwn, 8), shared = Columns<8>::Zero(kShared, 8);
  both.arrow.GatherBorder();
  both.arrow.Multiply<8>(x.topRows(kUnknowns + kOwn), x.bottomRows(kShared), y, &shared);
  EXPECT_LT((y - expected.topRows(kUnknowns + kOwn)).norm(), 1e-10 * expected.norm());
  EXPECT_LT((shared - expected.bottomRows(kShared)).norm(), 1e-10 * expected.norm());

  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(kShared, kShared);
  Eigen::VectorXd unused = Eigen::VectorXd::Zero(kShared);
  ASSERT_TRUE(both.arrow.Reduce(0, &matrix, &unused));
  both.arrow.Eliminate<8>(y, &shared);
  const Columns<8> solved = matrix.llt().solve(shared);
  both.arrow.Substitute<8>(solved, y);
  EXPECT_LT((solved - x.bottomRows(kShared)).norm(), 1e-8 * x.norm());
  EXPECT_LT((y - x.topRows(kUnknowns + kOwn)).norm(), 1e-8 * x.norm());
}

// Three at once, also where they reach beyond the path's end.
TEST(ArrowSystem, AddsThreeResidualsAsOneByOne) {
  Rng rng(9);
  for (const int first : {3, kUnknowns - 9}) {
    ArrowSystem::Rows rows;
    rows.first = first;
    rows.own = 1;
    auto& [early, late] = rows.by_shared;
    early.by.resize(3, 1);
    late.first = 1;
    late.by.resize(3, 2);
    for (double& v : rows.path.reshaped()) v = rng.Normal();
    for (double& v : early.by.reshaped()) v = rng.Normal();
    for (double& v : late.by.reshaped()) v = rng.Normal();
    const Eigen::Vector3d weight(0.5, 1, 2);
    Both one;
    for (int r = 0; r < 3; ++r) {
      ResidualRow row;
      row.first = first;
      row.residual = rows.residual[r] = rng.Normal();
      for (int a = 0; a < 12; ++a) row.path[static_cast<std::size_t>(a)] = rows.path(r, a);
      row.AddBorder(rows.own, rows.by_own[r] = rng.Normal());
      row.AddBorder(kOwn, early.by(r, 0));
      row.AddBorder(kOwn + 1, late.by(r, 0));
      row.AddBorder(kOwn + 2, late.by(r, 1));
      one.Add(row, weight[r]);
    }
    ArrowSystem three(kUnknowns, kOwn, kShared);
    three.Add(rows, weight);
    EXPECT_LT((three.gradient() - one.arrow.gradient()).norm(), 1e-12);
    EXPECT_LT((three.corner() - one.arrow.corner()).norm(), 1e-12);
    for (int i = 0; i < kUnknowns; ++i) {
      EXPECT_NEAR(three.Diagonal(i), one.arrow.Diagonal(i), 1e-12);
    }
    const Columns<1> ones = Columns<1>::Ones(kUnknowns + kOwn), last = Columns<1>::Ones(kShared);
    Columns<1> y = 0 * ones, out = 0 * last, other = y, others = out;
    three.GatherBorder();
    one.arrow.GatherBorder();
    three.Multiply<1>(ones, last, y, &out);
    one.arrow.Multiply<1>(ones, last, other, &others);
    EXPECT_LT((y - other).norm(), 1e-12);
    EXPECT_LT((out - others).norm(), 1e-12);
  }
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
  for (int first : {0, 45, 57, kUnknowns - 9}) {  // the last reaches past the end
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

// A path that shares nothing, in a system that has held another one.
TEST(ArrowSystem, IsUsedAgainAndNeedsNoBorder) {
  ArrowSystem alone(kUnknowns, 0, 0);
  Both twice = RandomSystem();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(kShared, kShared), none(0, 0);
  Eigen::VectorXd reduced = Eigen::VectorXd::Zero(kShared), nothing(0);
  ASSERT_TRUE(twice.arrow.Reduce(0, &matrix, &reduced));
  Both other;
  twice.arrow.SetZero();
  Rng rng(3);
  for (int k = 0; k < 300; ++k) {
    ResidualRow row;
    row.first = 3 * static_cast<int>(rng.Below(kUnknowns / 3));
    row.residual = rng.Normal();
    for (double& d : row.path) d = rng.Normal();
    alone.Add(row);
    // Now the path meets late what it met first, and the other way round.
    const int border = static_cast<int>(rng.Below(kOwn + kShared));
    if (Meets(kUnknowns - row.first, border)) row.AddBorder(border, rng.Normal());
    other.Add(row, 1);
    twice.arrow.Add(row);
  }
  const Eigen::MatrixXd normal = other.jacobian.transpose() * other.jacobian;
  const Eigen::VectorXd dense = -normal.ldlt().solve(other.jacobian.transpose() * other.residual);
  matrix.setZero();
  reduced.setZero();
  ASSERT_TRUE(twice.arrow.Reduce(0, &matrix, &reduced));
  const Eigen::VectorXd shared = -matrix.llt().solve(reduced);
  EXPECT_LT((shared - dense.tail(kShared)).norm(), 1e-9 * dense.norm());
  const Eigen::VectorXd step = twice.arrow.BackSubstitute(shared);
  EXPECT_LT((step - dense.head(kUnknowns + kOwn)).norm(), 1e-9 * dense.norm());

  const Eigen::MatrixXd path = other.jacobian.leftCols(kUnknowns);
  ASSERT_TRUE(alone.Reduce(0, &none, &nothing));
  const Eigen::VectorXd solved =
      -(path.transpose() * path).ldlt().solve(path.transpose() * other.residual);
  EXPECT_LT((alone.BackSubstitute(nothing) - solved).norm(), 1e-9 * solved.norm());
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
