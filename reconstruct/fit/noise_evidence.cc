// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/noise_evidence.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr double kJitter = 1e-12;  // animals in one place make equal rows

double LogDeterminant(const Eigen::LLT<Eigen::MatrixXd>& factor) {
  return 2 * factor.matrixLLT().diagonal().array().log().sum();
}

}  // namespace

NoiseEvidence::NoiseEvidence(const VelocitySample& sample, double scale)
    : design_(MakeNoiseDesign(sample.position, scale).matrix),
      y_(static_cast<Eigen::Index>(3 * sample.size())) {
  Check(sample.velocity.size() == sample.size(), "a velocity for each position");
  const std::array<double, 3> variance = GradientVariance();
  Eigen::VectorXd sd(design_.cols());
  for (Eigen::Index c = 0; c < sd.size(); ++c) sd[c] = std::sqrt(variance[c % 3]);
  design_ = design_ * sd.asDiagonal();
  for (std::size_t k = 0; k < sample.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(3 * k);
    y_[row] = sample.velocity[k].x;
    y_[row + 1] = sample.velocity[k].y;
    y_[row + 2] = sample.velocity[k].z;
  }
  projected_ = design_.transpose() * y_;
  const Eigen::SparseMatrix<double, Eigen::RowMajor> transposed = design_.transpose();
  gram_ =
      by_gradient() ? Eigen::MatrixXd(transposed * design_) : Eigen::MatrixXd(design_ * transposed);
}

Eigen::MatrixXd NoiseEvidence::Matrix(double r) const {
  Eigen::MatrixXd matrix = by_gradient() ? gram_ : r * gram_;
  matrix.diagonal().array() += by_gradient() ? 1 / r : 1.0;
  return matrix;
}

NoiseEvidence::Value NoiseEvidence::At(double r) const {
  const Eigen::LLT<Eigen::MatrixXd> factor(Matrix(r));
  if (by_gradient()) {
    const Eigen::VectorXd half = factor.matrixL().solve(projected_);
    return {LogDeterminant(factor) + static_cast<double>(design_.cols()) * std::log(r),
            y_.squaredNorm() - half.squaredNorm()};
  }
  const Eigen::VectorXd half = factor.matrixL().solve(y_);
  return {LogDeterminant(factor), half.squaredNorm()};
}

Eigen::VectorXd NoiseEvidence::Residual(double r) const {
  const Eigen::LLT<Eigen::MatrixXd> factor(Matrix(r));
  if (by_gradient()) return y_ - design_ * factor.solve(projected_);
  return factor.solve(y_);
}

std::vector<NoiseEvidence::LeftOut> NoiseEvidence::LeaveOneOut(double r) const {
  const Eigen::LLT<Eigen::MatrixXd> factor(Matrix(r));
  const Eigen::MatrixXd half =
      factor.matrixL().solve(by_gradient() ? Eigen::MatrixXd(design_.transpose())
                                           : Eigen::MatrixXd::Identity(y_.size(), y_.size()));
  const Eigen::VectorXd rest = Residual(r);
  std::vector<LeftOut> animals;
  for (Eigen::Index k = 0; k < y_.size(); k += 3) {
    const auto part = half.middleCols(k, 3);
    Eigen::Matrix3d block = part.transpose() * part;
    if (by_gradient()) block = Eigen::Matrix3d::Identity() - block;
    const Eigen::Vector3d own = rest.segment(k, 3), error = block.ldlt().solve(own);
    animals.push_back({error.squaredNorm(), own.dot(error)});
  }
  return animals;
}

// S = I - (I + r G)^-1 with G = design' design, or r W' W with W = L^-1 design, L L' = Sigma.
NoiseEvidence::GainScore NoiseEvidence::ScoreOfGain(double r) const {
  const Eigen::LLT<Eigen::MatrixXd> factor(Matrix(r));
  const Eigen::Index columns = design_.cols();
  Eigen::MatrixXd root;  // of S^2: root' root
  if (by_gradient()) {
    root = -factor.solve(Eigen::MatrixXd::Identity(columns, columns)) / r;
    root.diagonal().array() += 1;
  } else {
    const Eigen::MatrixXd w = factor.matrixL().solve(Eigen::MatrixXd(design_));
    Eigen::MatrixXd inner = w * w.transpose();
    inner.diagonal().array() += kJitter * inner.diagonal().maxCoeff();
    const Eigen::LLT<Eigen::MatrixXd> inner_factor(inner);
    const Eigen::MatrixXd upper = inner_factor.matrixU();
    root = r * (upper * w);
  }
  const std::array<double, 81> cumulants = GradientCumulants();
  GainScore score;
  for (Eigen::Index v = 0; v < columns; v += 3) {
    const auto part = root.middleCols(v, 3);
    const Eigen::Matrix3d block = part.transpose() * part;
    score.normal += 2 * block.trace();
    for (int n = 0; n < 81; ++n) {
      score.excess += cumulants[n] * block(n / 27, n / 9 % 3) * block(n / 3 % 3, n % 3);
    }
  }
  return score;
}

}  // namespace flocklift
