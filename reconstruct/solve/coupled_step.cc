// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A Gauss-Newton step of the flock with forces, by preconditioned conjugate gradients.

#include <Eigen/Cholesky>
#include <cmath>

#include "reconstruct/solve/coupled_flock.h"

namespace flocklift::internal {

Eigen::VectorXd CoupledFlock::Apply(const Eigen::VectorXd& x, double damping) const {
  const Eigen::Index size = model_.shared();
  Eigen::VectorXd y = Eigen::VectorXd::Zero(x.size());
  Eigen::MatrixXd priors = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd unused = Eigen::VectorXd::Zero(size);
  SharedPriors(model_, shared_, &priors, &unused);
  Eigen::VectorXd of_shared = priors * x.tail(size);
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    const Eigen::Index own = offset_[i + 1] - offset_[i];
    Eigen::VectorXd product = Eigen::VectorXd::Zero(own);
    const Eigen::VectorXd own_x = x.segment(offset_[i], own);
    batch_[i].AddProduct(own_x, x.tail(size), &product, &of_shared);
    for (Eigen::Index a = 0; a < own; ++a) {
      const bool is_depth = a < birds_[i].unknowns() && a % 3 == 2;
      product[a] +=
          damping * own_x[a] *
          (is_depth ? ArrowSystem::kDepthMetric : blocks_[i].Diagonal(static_cast<int>(a)));
    }
    y.segment(offset_[i], own) = product;
  }
  y.tail(size) = of_shared;
  AddDynamics(&x, &y);
  return y;
}

Eigen::VectorXd CoupledFlock::Precondition(const Eigen::MatrixXd& shared_matrix,
                                           const Eigen::VectorXd& x) {
  const Eigen::Index size = model_.shared();
  Eigen::VectorXd of_shared = x.tail(size);
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    of_shared += blocks_[i].ReduceGradient(x.segment(offset_[i], offset_[i + 1] - offset_[i]));
  }
  const Eigen::VectorXd shared_step = -shared_matrix.llt().solve(of_shared);
  Eigen::VectorXd y(x.size());
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    y.segment(offset_[i], offset_[i + 1] - offset_[i]) = -blocks_[i].BackSubstitute(shared_step);
  }
  y.tail(size) = -shared_step;
  return y;
}

// Conjugate gradients until the residual, in the metric of the blocks, is a twentieth. False when a
// block is singular.
bool CoupledFlock::Step(double damping, Eigen::VectorXd* step) {
  constexpr int kMostRounds = 40;
  constexpr double kTolerance = 0.05;
  const Eigen::VectorXd gradient = Gradient();
  const Eigen::Index size = model_.shared();
  Eigen::MatrixXd shared_matrix = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd shared_gradient = Eigen::VectorXd::Zero(size);
  SharedPriors(model_, shared_, &shared_matrix, &shared_gradient);
  for (ArrowSystem& block : blocks_) {
    if (!block.Reduce(damping, &shared_matrix, &shared_gradient)) return false;
  }
  *step = Eigen::VectorXd::Zero(gradient.size());
  Eigen::VectorXd residual = -gradient;
  Eigen::VectorXd z = Precondition(shared_matrix, residual);
  Eigen::VectorXd direction = z;
  double rz = residual.dot(z);
  const double first = rz;
  for (int round = 0; round < kMostRounds && rz > kTolerance * kTolerance * first; ++round) {
    const Eigen::VectorXd product = Apply(direction, damping);
    const double curvature = direction.dot(product);
    if (!(curvature > 0) || !std::isfinite(curvature)) break;
    const double length = rz / curvature;
    *step += length * direction;
    residual -= length * product;
    z = Precondition(shared_matrix, residual);
    const double next = residual.dot(z);
    direction = z + (next / rz) * direction;
    rz = next;
  }
  return step->allFinite();
}

}  // namespace flocklift::internal
