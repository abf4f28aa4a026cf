// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/conjugate_gradients.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "reconstruct/solve/arrow_system.h"
#include "simulate/core/rng.h"

namespace flocklift::internal {
namespace {

Eigen::MatrixXd RandomMatrix(int n) {
  Rng rng(3);
  Eigen::MatrixXd root(n, n);
  for (double& x : root.reshaped()) x = rng.Normal();
  const Eigen::MatrixXd scales = Eigen::VectorXd::LinSpaced(n, 1, 30).asDiagonal();
  return root * scales * root.transpose() + Eigen::MatrixXd::Identity(n, n);
}

TEST(ConjugateGradients, SolvesEveryColumnAsADirectFactorDoes) {
  constexpr int kSize = 20;
  const Eigen::MatrixXd matrix = RandomMatrix(kSize);
  Columns<8> b = Columns<8>::Zero(kSize, 8);  // the last ask for nothing
  Rng rng(5);
  for (double& x : b.leftCols(5).reshaped()) x = rng.Normal();
  const Columns<8> x = ConjugateGradients(
      b, {.share = 1e-14, .most = 500},
      [&](const Columns<8>& v, Columns<8>* y) { *y = matrix * v; },
      [&](Columns<8>* v) { *v = matrix.diagonal().cwiseInverse().asDiagonal() * *v; });
  const Eigen::MatrixXd direct = matrix.llt().solve(b);
  for (int c = 0; c < 8; ++c) {
    EXPECT_LT((x.col(c) - direct.col(c)).norm(), 1e-6 * direct.norm()) << c;
  }
  EXPECT_EQ(x.rightCols(3).norm(), 0);
}

TEST(ConjugateGradients, AnExactPreconditionerNeedsOneStep) {
  const Eigen::MatrixXd matrix = RandomMatrix(7);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(7, -1, 2);
  int iterations = 0;
  const Eigen::VectorXd x = ConjugateGradients(
      b, {.share = 1e-6, .most = 50},
      [&](const Eigen::VectorXd& v, Eigen::VectorXd* y) { *y = matrix * v; },
      [&](Eigen::VectorXd* v) { *v = matrix.llt().solve(*v).eval(); }, &iterations);
  EXPECT_LE(iterations, 2);  // the second finds nothing left
  EXPECT_LT((matrix * x - b).norm(), 1e-9 * b.norm());
}

TEST(ConjugateGradients, StopsWhereIterationsGainLittle) {
  const Eigen::MatrixXd matrix = RandomMatrix(40);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(40);
  const auto iterations_to = [&](double share) {
    int iterations = 0;
    ConjugateGradients(
        b, {.share = share, .most = 1000},
        [&](const Eigen::VectorXd& v, Eigen::VectorXd* y) { *y = matrix * v; },
        [](Eigen::VectorXd*) {}, &iterations);
    return iterations;
  };
  EXPECT_LT(iterations_to(0.1), iterations_to(1e-8));
}

}  // namespace
}  // namespace flocklift::internal
