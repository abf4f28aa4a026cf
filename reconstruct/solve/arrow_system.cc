// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/arrow_system.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "simulate/core/check.h"

namespace flocklift::internal {
namespace {

constexpr int kBand = ArrowSystem::kBand;

// Entry (i, j) of a stored lower band, i - 11 <= j <= i.
std::size_t At(int i, int j) { return static_cast<std::size_t>(i) * kBand + (j - i + kBand - 1); }

}  // namespace

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
  for (int a = 0; a < count; ++a) {
    const double scaled = weight * row.path[a];
    if (scaled == 0) continue;
    const int i = row.first + a;
    double* out = &band_[At(i, row.first)];
    for (int b = 0; b <= a; ++b) out[b] += scaled * row.path[b];
    gradient_[i] += scaled * row.residual;
    for (int c = 0; c < row.border_count; ++c) {
      border_(row.border[c].first, i) += scaled * row.border[c].second;
    }
  }
  for (int c = 0; c < row.border_count; ++c) {
    const auto [i, derivative] = row.border[c];
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
  const int last = k_ - static_cast<int>(rows.by_last.cols());
  const Eigen::Matrix<double, kBand, 3> weighted = rows.path.transpose() * weight.asDiagonal();
  Add(rows.first, weighted * rows.path, weighted * rows.residual);
  border_.row(rows.own).segment(rows.first, count) += (weighted * rows.by_own).head(count);
  border_.bottomRows(rows.by_last.cols()).middleCols(rows.first, count).noalias() +=
      rows.by_last.transpose() * weighted.topRows(count).transpose();
  const Eigen::Vector3d own = weight.cwiseProduct(rows.by_own);
  const Eigen::MatrixXd by_last = weight.asDiagonal() * rows.by_last;
  const Eigen::VectorXd across = by_last.transpose() * rows.by_own;
  corner_(rows.own, rows.own) += own.dot(rows.by_own);
  corner_.row(rows.own).tail(across.size()) += across.transpose();
  corner_.col(rows.own).tail(across.size()) += across;
  corner_.bottomRightCorner(across.size(), across.size()).noalias() +=
      by_last.transpose() * rows.by_last;
  gradient_[n_ + rows.own] += own.dot(rows.residual);
  gradient_.tail(k_ - last).noalias() += by_last.transpose() * rows.residual;
}

double ArrowSystem::Diagonal(int i) const { return band_[At(i, i)]; }

bool ArrowSystem::Reduce(double damping, Eigen::MatrixXd* shared_matrix,
                         Eigen::VectorXd* shared_gradient) {
  for (int i = 0; i < n_; ++i) {
    const int low = std::max(0, i - kBand + 1);
    double* row = &factor_[At(i, low)] - low;  // row[j] is entry (i, j)
    for (int j = low; j <= i; ++j) {
      double sum = band_[At(i, j)];
      if (j == i) sum += damping * (i % 3 == 2 ? ArrowSystem::kDepthMetric : sum);
      const double* other =
          &factor_[At(j, std::max(0, j - kBand + 1))] - std::max(0, j - kBand + 1);
      for (int m = std::max(low, j - kBand + 1); m < j; ++m) sum -= row[m] * other[m];
      if (j < i) {
        row[j] = sum / other[j];
      } else {
        if (!(sum > 1e-12 * band_[At(i, i)]) || !std::isfinite(sum)) return false;
        row[i] = std::sqrt(sum);
      }
    }
  }
  reduced_border_ = border_;
  reduced_gradient_ = gradient_.head(n_);
  for (int i = 0; i < n_; ++i) {
    for (int j = std::max(0, i - kBand + 1); j < i; ++j) {
      const double l = factor_[At(i, j)];
      reduced_border_.col(i) -= l * reduced_border_.col(j);
      reduced_gradient_[i] -= l * reduced_gradient_[j];
    }
    const double inverse = 1 / factor_[At(i, i)];
    reduced_border_.col(i) *= inverse;
    reduced_gradient_[i] *= inverse;
  }
  Eigen::MatrixXd schur = corner_;
  for (int a = 0; a < own_; ++a) schur(a, a) *= 1 + damping;
  schur.noalias() -= reduced_border_ * reduced_border_.transpose();
  const Eigen::VectorXd gradient = gradient_.tail(k_) - reduced_border_ * reduced_gradient_;

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
  step.head(n_) = -reduced_gradient_ - reduced_border_.transpose() * border;
  SolveBandInPlace(step.head(n_));
  step.tail(own_) = own;
  return step;
}

template <int Count>
void ArrowSystem::Multiply(const Eigen::Ref<const Columns<Count>>& x, const Columns<Count>& shared,
                           Eigen::Ref<Columns<Count>> y, Columns<Count>* out) const {
  Columns<Count> border(k_, Count);
  border << x.bottomRows(own_), shared;
  for (int i = 0; i < n_; ++i) {
    const int low = std::max(0, i - kBand + 1);
    const double* row = &band_[At(i, low)] - low;
    Eigen::Matrix<double, 1, Count> sum = row[i] * x.row(i);
    for (int j = low; j < i; ++j) {
      sum += row[j] * x.row(j);
      y.row(j) += row[j] * x.row(i);
    }
    y.row(i) += sum;
  }
  y.topRows(n_).noalias() += border_.transpose() * border;
  Columns<Count> ends = corner_ * border;
  ends.noalias() += border_ * x.topRows(n_);
  y.bottomRows(own_) += ends.topRows(own_);
  *out += ends.bottomRows(k_ - own_);
}

template <int Count>
void ArrowSystem::Eliminate(Eigen::Ref<Columns<Count>> x, Columns<Count>* shared) const {
  for (int i = 0; i < n_; ++i) {
    const int low = std::max(0, i - kBand + 1);
    const double* row = &factor_[At(i, low)] - low;
    Eigen::Matrix<double, 1, Count> sum = x.row(i);
    for (int j = low; j < i; ++j) sum -= row[j] * x.row(j);
    x.row(i) = sum / row[i];
  }
  const Columns<Count> ends = reduced_border_ * x.topRows(n_);
  x.bottomRows(own_) -= ends.topRows(own_);
  own_factor_.triangularView<Eigen::Lower>().solveInPlace(x.bottomRows(own_));
  own_factor_.transpose().triangularView<Eigen::Upper>().solveInPlace(x.bottomRows(own_));
  *shared -= ends.bottomRows(k_ - own_);
  shared->noalias() -= own_to_shared_.transpose() * x.bottomRows(own_);
}

template <int Count>
void ArrowSystem::Substitute(const Columns<Count>& shared, Eigen::Ref<Columns<Count>> x) const {
  Columns<Count> border(k_, Count);
  border.topRows(own_) = own_to_shared_ * shared;
  own_factor_.triangularView<Eigen::Lower>().solveInPlace(border.topRows(own_));
  own_factor_.transpose().triangularView<Eigen::Upper>().solveInPlace(border.topRows(own_));
  x.bottomRows(own_) -= border.topRows(own_);
  border.topRows(own_) = x.bottomRows(own_);
  border.bottomRows(k_ - own_) = shared;
  x.topRows(n_).noalias() -= reduced_border_.transpose() * border;
  for (int i = n_ - 1; i >= 0; --i) {
    const int low = std::max(0, i - kBand + 1);
    const double* row = &factor_[At(i, low)] - low;
    x.row(i) /= row[i];
    for (int j = low; j < i; ++j) x.row(j) -= row[j] * x.row(i);
  }
}

template void ArrowSystem::Multiply<1>(const Eigen::Ref<const Columns<1>>&, const Columns<1>&,
                                       Eigen::Ref<Columns<1>>, Columns<1>*) const;
template void ArrowSystem::Multiply<8>(const Eigen::Ref<const Columns<8>>&, const Columns<8>&,
                                       Eigen::Ref<Columns<8>>, Columns<8>*) const;
template void ArrowSystem::Eliminate<1>(Eigen::Ref<Columns<1>>, Columns<1>*) const;
template void ArrowSystem::Eliminate<8>(Eigen::Ref<Columns<8>>, Columns<8>*) const;
template void ArrowSystem::Substitute<1>(const Columns<1>&, Eigen::Ref<Columns<1>>) const;
template void ArrowSystem::Substitute<8>(const Columns<8>&, Eigen::Ref<Columns<8>>) const;

ArrowSystem::Posterior ArrowSystem::Covariance(const Eigen::MatrixXd& shared_covariance) const {
  Posterior posterior;
  const int shared = k_ - own_;
  Eigen::MatrixXd own_inverse = Eigen::MatrixXd::Identity(own_, own_);
  own_factor_.triangularView<Eigen::Lower>().solveInPlace(own_inverse);
  own_inverse = own_inverse.transpose() * own_inverse;
  const Eigen::MatrixXd across = own_inverse * own_to_shared_;
  posterior.border.resize(k_, k_);
  posterior.border.topLeftCorner(own_, own_) =
      own_inverse + across * shared_covariance * across.transpose();
  posterior.border.topRightCorner(own_, shared) = -across * shared_covariance;
  posterior.border.bottomLeftCorner(shared, own_) =
      posterior.border.topRightCorner(own_, shared).transpose();
  posterior.border.bottomRightCorner(shared, shared) = shared_covariance;

  posterior.path_to_border = -reduced_border_.transpose();
  for (int c = 0; c < k_; ++c) SolveBandInPlace(posterior.path_to_border.col(c));

  // Z = A^-1 inside the band, from the last row up: Z L = L^-T.
  posterior.band.assign(band_.size(), 0.0);
  std::vector<double>& z = posterior.band;
  for (int j = n_ - 1; j >= 0; --j) {
    const int high = std::min(n_ - 1, j + kBand - 1);
    const double inverse = 1 / factor_[At(j, j)];
    for (int i = high; i >= j; --i) {
      double sum = i == j ? inverse : 0.0;
      for (int m = j + 1; m <= high; ++m) {
        const double entry = m >= i ? z[At(m, i)] : z[At(i, m)];
        sum -= entry * factor_[At(m, j)];
      }
      z[At(i, j)] = sum * inverse;
    }
  }
  return posterior;
}

double ArrowSystem::VarianceOf(const Posterior& posterior, const ResidualRow& row) const {
  const int count = std::min(kBand, n_ - row.first);
  double variance = 0;
  Eigen::VectorXd border = Eigen::VectorXd::Zero(k_);
  for (int a = 0; a < count; ++a) {
    if (row.path[a] == 0) continue;
    const int i = row.first + a;
    border += row.path[a] * posterior.path_to_border.row(i).transpose();
    for (int b = 0; b <= a; ++b) {
      const double entry = posterior.band[At(i, row.first + b)];
      variance += (b == a ? 1 : 2) * row.path[a] * row.path[b] * entry;
    }
  }
  for (int c = 0; c < row.border_count; ++c) border[row.border[c].first] += row.border[c].second;
  return variance + border.dot(posterior.border * border);
}

std::pair<double, Eigen::VectorXd> ArrowSystem::Functional(const Eigen::VectorXd& weights) const {
  // L^-1 w, then everything as for a right-hand side.
  Eigen::VectorXd y = weights;
  for (int i = 0; i < n_; ++i) {
    for (int j = std::max(0, i - kBand + 1); j < i; ++j) y[i] -= factor_[At(i, j)] * y[j];
    y[i] /= factor_[At(i, i)];
  }
  double variance = y.squaredNorm();
  const Eigen::VectorXd border = -(reduced_border_ * y);
  Eigen::VectorXd own = border.head(own_);
  own_factor_.triangularView<Eigen::Lower>().solveInPlace(own);
  variance += own.squaredNorm();
  own_factor_.transpose().triangularView<Eigen::Upper>().solveInPlace(own);
  return {variance, border.tail(k_ - own_) - own_to_shared_.transpose() * own};
}

}  // namespace flocklift::internal
