// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/arrow_system.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace flocklift::internal {

ArrowSystem::ArrowSystem(int n, int own, int shared)
    : n_(n),
      own_(own),
      k_(own + shared),
      band_(static_cast<std::size_t>(n) * kBand),
      border_(k_, n),
      corner_(k_, k_),
      gradient_(n + k_),
      factor_(band_.size()) {
  SetZero();
}

void ArrowSystem::SetZero() {
  pieces_.clear();
  met_.assign(static_cast<std::size_t>(k_), n_);
  left_.assign(static_cast<std::size_t>(k_), 0);
  std::fill(band_.begin(), band_.end(), 0.0);
  border_.setZero();
  corner_.setZero();
  gradient_.setZero();
}

void ArrowSystem::SetIdentity() {
  SetZero();
  for (int i = 0; i < n_; ++i) band_[At(i, i)] = 1;
  for (int a = 0; a < own_; ++a) corner_(a, a) = 1;
}

void ArrowSystem::Add(const ResidualRow& row, double weight) {
  const int count = std::min(kBand, n_ - row.first);
  std::array<int, kBand> present;
  int size = 0;
  for (int a = 0; a < count; ++a) {
    if (row.path[a] != 0) present[size++] = a;
  }
  const bool sparse = 2 * size <= kBand;  // as of a sighting, with four unknowns of the twelve
  for (int n = 0; n < size; ++n) {
    const int a = present[n], i = row.first + a;
    const double scaled = weight * row.path[a];
    double* out = &band_[At(i, row.first)];
    if (sparse) {
      for (int m = 0; m <= n; ++m) out[present[m]] += scaled * row.path[present[m]];
    } else {
      for (int b = 0; b <= a; ++b) out[b] += scaled * row.path[b];
    }
    gradient_[i] += scaled * row.residual;
    for (int c = 0; c < row.border_count; ++c) {
      border_(row.border[c].first, i) += scaled * row.border[c].second;
    }
  }
  for (int c = 0; c < row.border_count; ++c) {
    const auto [i, derivative] = row.border[c];
    Meet(i, row.first);
    gradient_[n_ + i] += weight * derivative * row.residual;
    for (int d = 0; d < row.border_count; ++d) {
      corner_(i, row.border[d].first) += weight * derivative * row.border[d].second;
    }
  }
}

void ArrowSystem::Add(int first, const Square& square, const Pull& pull) {
  const int count = std::min(kBand, n_ - first);
  for (int a = 0; a < count; ++a) {
    double* out = &band_[At(first + a, first)];
    for (int b = 0; b <= a; ++b) out[b] += square(a, b);
  }
  gradient_.segment(first, count) += pull.head(count);
}

void ArrowSystem::Add(const Rows& rows, const Eigen::Vector3d& weight) {
  const int count = std::min(kBand, n_ - rows.first);
  const Eigen::Matrix<double, kBand, 3> weighted = rows.path.transpose() * weight.asDiagonal();
  Add(rows.first, weighted.lazyProduct(rows.path), weighted * rows.residual);
  border_.row(rows.own).segment(rows.first, count) += (weighted * rows.by_own).head(count);
  Meet(rows.own, rows.first);
  const Eigen::Vector3d own = weight.cwiseProduct(rows.by_own);
  corner_(rows.own, rows.own) += own.dot(rows.by_own);
  gradient_[n_ + rows.own] += own.dot(rows.residual);
  for (const Rows::Run& run : rows.by_shared) {
    const int first = own_ + run.first, size = static_cast<int>(run.by.cols());
    const auto by = run.by.transpose();
    border_.block(first, rows.first, size, count) +=
        by.lazyProduct(weighted.topRows(count).transpose());
    for (int c = first; c < first + size; ++c) Meet(c, rows.first);
    const Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, Rows::Run::kMost, 1> across =
        by.lazyProduct(own);
    corner_.row(rows.own).segment(first, size) += across.transpose();
    corner_.col(rows.own).segment(first, size) += across;
    gradient_.segment(n_ + first, size) += by.lazyProduct(weight.cwiseProduct(rows.residual));
    for (const Rows::Run& other : rows.by_shared) {
      corner_.block(first, own_ + other.first, size, other.by.cols()) +=
          by.lazyProduct(weight.asDiagonal() * other.by);
    }
  }
}

void ArrowSystem::Meet(int border, int first) {
  met_[border] = std::min(met_[border], first);
  left_[border] = std::max(left_[border], std::min(first + kBand, n_));
}

double ArrowSystem::Diagonal(int i) const { return band_[At(i, i)]; }

void ArrowSystem::SortBorder() {
  order_.resize(static_cast<std::size_t>(k_));
  std::iota(order_.begin(), order_.end(), 0);
  std::stable_sort(order_.begin(), order_.end(),
                   [this](int a, int b) { return met_[a] < met_[b]; });
}

// Column by column, each taken off the rows below it: sums of the same order as row by row, but
// without a chain of additions.
bool ArrowSystem::FactoriseBand(double damping) {
  factor_ = band_;
  for (int i = 0; i < n_; ++i) {
    double& diagonal = factor_[At(i, i)];
    diagonal += damping * (i % 3 == 2 ? ArrowSystem::kDepthMetric : diagonal);
  }
  std::array<double, kBand> column;
  for (int i = 0; i < n_; ++i) {
    const double diagonal = band_[At(i, i)];
    double& pivot = factor_[At(i, i)];
    if (!(pivot > 1e-12 * diagonal) || !std::isfinite(pivot)) return false;
    pivot = std::sqrt(pivot);
    const int below = std::min(kBand - 1, n_ - 1 - i);
    for (int a = 1; a <= below; ++a) {
      column[a] = factor_[At(i + a, i)] /= pivot;
      double* row = &factor_[At(i + a, i)];
      for (int b = 1; b <= a; ++b) row[b] -= column[a] * column[b];
    }
  }
  return true;
}

void ArrowSystem::ReduceBorder(Eigen::MatrixXd* squares, Eigen::VectorXd* pulls) {
  SortBorder();
  reduced_border_.resize(k_, n_);
  reduced_gradient_ = gradient_.head(n_);
  int met_before = 0;
  ForEachBlock([&](int first, int columns, int met) {
    // What the block before had not met yet is zero there.
    const int before = std::max(0, first - kBand + 1);
    reduced_border_.block(met_before, before, met - met_before, first - before).setZero();
    met_before = met;
    for (int i = first; i < first + columns; ++i) {
      auto column = reduced_border_.col(i).head(met);
      for (int c = 0; c < met; ++c) column[c] = border_(order_[c], i);
      for (int j = std::max(0, i - kBand + 1); j < i; ++j) {
        const double l = factor_[At(i, j)];
        column -= l * reduced_border_.col(j).head(met);
        reduced_gradient_[i] -= l * reduced_gradient_[j];
      }
      const double inverse = 1 / factor_[At(i, i)];
      column *= inverse;
      reduced_gradient_[i] *= inverse;
    }
    if (met == 0) return;
    const auto block = reduced_border_.block(0, first, met, columns);
    squares->topLeftCorner(met, met).selfadjointView<Eigen::Lower>().rankUpdate(block);
    pulls->head(met).noalias() += block * reduced_gradient_.segment(first, columns);
  });
}

bool ArrowSystem::Reduce(double damping, Eigen::MatrixXd* shared_matrix,
                         Eigen::VectorXd* shared_gradient) {
  if (!FactoriseBand(damping)) return false;
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(k_, k_);
  Eigen::VectorXd pulls = Eigen::VectorXd::Zero(k_);
  ReduceBorder(&squares, &pulls);
  Eigen::MatrixXd schur = corner_;
  for (int a = 0; a < own_; ++a) schur(a, a) *= 1 + damping;
  Eigen::VectorXd gradient = gradient_.tail(k_);
  for (int a = 0; a < k_; ++a) {
    gradient[order_[a]] -= pulls[a];
    for (int b = 0; b < k_; ++b) {
      schur(order_[a], order_[b]) -= squares(std::max(a, b), std::min(a, b));
    }
  }

  const int shared = k_ - own_;
  const Eigen::LLT<Eigen::MatrixXd> own(schur.topLeftCorner(own_, own_));
  if (own_ > 0 && own.info() != Eigen::Success) return false;
  own_factor_ = own.matrixL();
  own_to_shared_ = schur.topRightCorner(own_, shared);
  own_gradient_ = gradient.head(own_);
  if (!own_gradient_.allFinite() || !own_factor_.allFinite()) return false;
  const Eigen::MatrixXd across = own.solve(own_to_shared_);
  *shared_matrix += schur.bottomRightCorner(shared, shared) - own_to_shared_.transpose() * across;
  *shared_gradient += gradient.tail(shared) - across.transpose() * own_gradient_;
  return true;
}

void ArrowSystem::SolveBandInPlace(Eigen::Ref<Eigen::VectorXd> x) const {
  for (int i = n_ - 1; i >= 0; --i) {
    x[i] /= factor_[At(i, i)];
    for (int j = std::max(0, i - kBand + 1); j < i; ++j) x[j] -= factor_[At(i, j)] * x[i];
  }
}

Eigen::VectorXd ArrowSystem::BackSubstitute(const Eigen::VectorXd& shared_step) const {
  Eigen::VectorXd step(n_ + own_);
  Eigen::VectorXd own = -own_gradient_ - own_to_shared_ * shared_step;
  own_factor_.triangularView<Eigen::Lower>().solveInPlace(own);
  own_factor_.transpose().triangularView<Eigen::Upper>().solveInPlace(own);
  Eigen::VectorXd border(k_);
  border << own, shared_step;
  step.head(n_) = -reduced_gradient_;
  SubtractReduced<1>(border, step.head(n_));
  SolveBandInPlace(step.head(n_));
  step.tail(own_) = own;
  return step;
}

}  // namespace flocklift::internal
