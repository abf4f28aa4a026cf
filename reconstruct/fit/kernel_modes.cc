// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/kernel_modes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

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

constexpr double kFirstRate = 0.01, kLastRate = 2, kRateStep = 1.5;  // of `rates` [1/frame]

// What a velocity over u - 1 .. u + 1 has of a kick of 1 at time 0 that it forgets [frames].
double Felt(double u, double rate) {
  if (u <= -1) return 0;
  if (rate == 0) return std::min(1.0, 0.5 * (u + 1));
  if (u < 1) return -std::expm1(-rate * (u + 1)) / (2 * rate);
  return std::exp(-rate * u) * std::sinh(rate) / rate;
}

// Its integral under the triangle of a second difference that lies `lag` frames before.
double FeltOfTriangle(Index lag, double rate) {
  constexpr int kPanels = 16;  // Simpson's, from -1 to 1: kinks lie at whole frames
  double sum = 0;
  for (int k = 0; k <= kPanels; ++k) {
    const double s = -1 + 2.0 * k / kPanels;
    const double weight = k == 0 || k == kPanels ? 1 : k % 2 == 1 ? 4 : 2;
    sum += weight * (1 - std::abs(s)) * Felt(static_cast<double>(lag) - s, rate);
  }
  return sum * 2 / (3 * kPanels);
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

MatrixXd KernelSharedNoise(int order, int frames, double dt, double rate) {
  Check(rate >= 0, "noise is forgotten at a rate of 0 or more");
  const double of_frame = rate * dt;
  // By how many frames the state is behind the row: of order 1 row k ends at frame k + 1, of order
  // 2 it lies about frame k + 1.
  std::vector<double> felt;
  for (Index past = 0; past <= frames; ++past) {
    if (order == 2) {
      felt.push_back(2 * dt * dt * FeltOfTriangle(past - 1, of_frame));
    } else {
      const double first = of_frame > 0 ? -std::expm1(-of_frame) / of_frame : 1;
      const double decay = std::exp(-of_frame * static_cast<double>(past - 1));
      felt.push_back(past == 0 ? 0 : 2 * dt * first * decay);
    }
  }
  MatrixXd c = MatrixXd::Zero(frames - order, frames);
  for (Index k = 0; k < c.rows(); ++k) {
    for (Index m = k; m < frames; ++m) c(k, m) = felt[static_cast<std::size_t>(m - k)];
  }
  return c;
}

KernelModes MakeKernelModes(int order, int frames, double dt) {
  const MatrixXd quadrature = KernelQuadrature(order, frames, dt);
  const MatrixXd d = Differences(order, frames);
  const MatrixXd a = d * d.transpose();
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(
      a, ProcessCovariance(order, d.rows(), dt));
  const MatrixXd& u = solver.eigenvectors();
  KernelModes modes{.difference = u.transpose() * d,
                    .average = u.transpose() * quadrature,
                    .lambda = solver.eigenvalues().cwiseMax(0.0),
                    .rates = {0},
                    .shared = {}};
  for (double rate = kFirstRate; rate < kLastRate; rate *= kRateStep) {
    modes.rates.push_back(rate / dt);
  }
  for (const double rate : modes.rates) {
    modes.shared.emplace_back(u.transpose() * KernelSharedNoise(order, frames, dt, rate));
  }
  return modes;
}

MatrixXd KernelModes::Kappa(double position_variance, double diffusion) const {
  const Eigen::VectorXd weight =
      (position_variance * lambda.array() + diffusion).inverse().matrix();
  const MatrixXd weighted = weight.asDiagonal() * average;
  MatrixXd kappa(average.cols(), static_cast<Index>(rates.size()));
  for (std::size_t k = 0; k < rates.size(); ++k) {
    kappa.col(static_cast<Index>(k)) = weighted.cwiseProduct(shared[k]).colwise().sum().transpose();
  }
  return kappa;
}

}  // namespace flocklift
