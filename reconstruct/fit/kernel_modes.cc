// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/kernel_modes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

MatrixXd Differences(int order, Index frames) {
  MatrixXd d = MatrixXd::Zero(frames - order, frames);
  for (Index k = 0; k < d.rows(); ++k) {
    if (order == 1) {
      d(k, k) = -1;
      d(k, k + 1) = 1;
    } else {
      d(k, k) = d(k, k + 2) = 1;
      d(k, k + 1) = -2;
    }
  }
  return d;
}

MatrixXd ProcessCovariance(int order, Index rows, double dt) {
  if (order == 1) return 2 * dt * MatrixXd::Identity(rows, rows);
  MatrixXd b = MatrixXd::Zero(rows, rows);
  for (Index k = 0; k < rows; ++k) {
    b(k, k) = 4.0 / 3 * dt * dt * dt;
    if (k > 0) b(k, k - 1) = b(k - 1, k) = dt * dt * dt / 3;
  }
  return b;
}

// rows x F: covariance of the noise of a row and the state of a frame, for D = 1.
MatrixXd SharedNoise(int order, Index frames, double dt) {
  MatrixXd c = MatrixXd::Zero(frames - order, frames);
  for (Index k = 0; k < c.rows(); ++k) {
    for (Index m = 0; m < frames; ++m) {
      if (order == 1) {
        c(k, m) = m > k ? 2 * dt : 0;  // row k is the increment to frame k + 1
        continue;
      }
      // The triangle about frame k + 1 under what a velocity over m - 1 .. m + 1 has felt.
      constexpr double kFelt[] = {1.0 / 12, 0.5, 11.0 / 12};
      const Index past = m - (k + 1);
      c(k, m) = 2 * dt * dt * (past < -1 ? 0 : past > 1 ? 1 : kFelt[past + 1]);
    }
  }
  return c;
}

}  // namespace

MatrixXd KernelQuadrature(int order, int frames, double dt) {
  Check(order == 1 || order == 2, "the order of a motion is 1 or 2");
  Check(frames >= ShortestRun(order), "a run is too short");
  MatrixXd q = MatrixXd::Zero(frames - order, frames);
  const Index last = q.rows() - 1;
  for (Index k = 0; k <= last; ++k) {
    if (order == 1) {
      if (k == 0) {
        q.block<1, 3>(k, 0) << 5, 8, -1;
        q.row(k) *= dt / 12;
      } else if (k == last) {
        q.block<1, 3>(k, k - 1) << -1, 8, 5;
        q.row(k) *= dt / 12;
      } else {
        q.block<1, 4>(k, k - 1) << -1, 13, 13, -1;
        q.row(k) *= dt / 24;
      }
    } else if (k == 0 || k == last) {
      q(k, k + 1) = dt * dt;  // the end frames have no velocity
    } else {
      q.block<1, 3>(k, k) << 1, 10, 1;
      q.row(k) *= dt * dt / 12;
    }
  }
  return q;
}

KernelModes MakeKernelModes(int order, int frames, double dt) {
  const MatrixXd quadrature = KernelQuadrature(order, frames, dt);
  const MatrixXd d = Differences(order, frames);
  const MatrixXd a = d * d.transpose();
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(
      a, ProcessCovariance(order, d.rows(), dt));
  const MatrixXd& u = solver.eigenvectors();
  return {.difference = u.transpose() * d,
          .average = u.transpose() * quadrature,
          .lambda = solver.eigenvalues().cwiseMax(0.0),
          .shared = u.transpose() * SharedNoise(order, frames, dt)};
}

Eigen::VectorXd KernelModes::Kappa(double position_variance, double diffusion) const {
  const Eigen::ArrayXd weight = 1 / (position_variance * lambda.array() + diffusion);
  return average.cwiseProduct(weight.matrix().asDiagonal() * shared).colwise().sum().transpose();
}

}  // namespace flocklift
