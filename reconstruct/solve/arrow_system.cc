// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/arrow_system.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

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

void ArrowSystem::GatherBorder() {
  pieces_.clear();
  for (int first = 0; first < n_; first += kColumns) {
    Piece& piece = pieces_.emplace_back();
    piece.first = first;
    const int columns = std::min(kColumns, n_ - first);
    for (int c = 0; c < k_; ++c) {
      if (met_[c] < first + columns && left_[c] > first) piece.border.push_back(c);
    }
    piece.values = border_(piece.border, Eigen::seqN(first, columns));
  }
}

double ArrowSystem::Diagonal(int i) const { return band_[At(i, i)]; }

template <typename Visit>
void ArrowSystem::ForEachBlock(const Visit& visit) const {
  int met = 0;
  for (int first = 0; first < n_; first += kColumns) {
    const int columns = std::min(kColumns, n_ - first);
    while (met < k_ && met_[order_[met]] < first + columns) ++met;
    visit(first, columns, met);
  }
}

void ArrowSystem::SortBorder() {
  order_.resize(static_cast<std::size_t>(k_));
  std::iota(order_.begin(), order_.end(), 0);
  std::stable_sort(order_.begin(), order_.end(),
                   [this](int a, int b) { return met_[a] < met_[b]; });
}

template <int Count>
Columns<Count> ArrowSystem::ReducedTimes(const Eigen::Ref<const Columns<Count>>& x) const {
  Columns<Count> sorted = Columns<Count>::Zero(k_, Count), border(k_, Count);
  ForEachBlock([&](int first, int columns, int met) {
    sorted.topRows(met).noalias() +=
        reduced_border_.block(0, first, met, columns) * x.middleRows(first, columns);
  });
  for (int c = 0; c < k_; ++c) border.row(order_[c]) = sorted.row(c);
  return border;
}

template <int Count>
void ArrowSystem::SubtractReduced(const Columns<Count>& border,
                                  Eigen::Ref<Columns<Count>> x) const {
  Columns<Count> sorted(k_, Count);
  for (int c = 0; c < k_; ++c) sorted.row(c) = border.row(order_[c]);
  ForEachBlock([&](int first, int columns, int met) {
    x.middleRows(first, columns).noalias() -=
        reduced_border_.block(0, first, met, columns).transpose() * sorted.topRows(met);
  });
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

bool ArrowSystem::Reduce(double damping, Eigen::MatrixXd* shared_matrix,
                         Eigen::VectorXd* shared_gradient) {
  if (!FactoriseBand(damping)) return false;
  SortBorder();
  reduced_border_.resize(k_, n_);
  reduced_gradient_ = gradient_.head(n_);
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(k_, k_);
  Eigen::VectorXd pulls = Eigen::VectorXd::Zero(k_);
  int met_before = 0;
  ForEachBlock([&](int first, int columns, int met) {
    const int before = std::max(0, first - kBand + 1);  // columns of the last block, shorter
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
    const auto block = reduced_border_.block(0, first, met, columns);
    squares.topLeftCorner(met, met).selfadjointView<Eigen::Lower>().rankUpdate(block);
    pulls.head(met).noalias() += block * reduced_gradient_.segment(first, columns);
  });
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

template <int Count>
void ArrowSystem::Multiply(const Eigen::Ref<const Columns<Count>>& x, const Columns<Count>& shared,
                           Eigen::Ref<Columns<Count>> y, Columns<Count>* out) const {
  FLOCKLIFT_DCHECK(!pieces_.empty());
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
  Columns<Count> ends = corner_ * border;
  for (const Piece& piece : pieces_) {
    const Eigen::Index columns = piece.values.cols();
    const Columns<Count> met = border(piece.border, Eigen::all);
    y.middleRows(piece.first, columns).noalias() += piece.values.transpose() * met;
    ends(piece.border, Eigen::all) += piece.values * x.middleRows(piece.first, columns);
  }
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
  const Columns<Count> ends = ReducedTimes<Count>(x.topRows(n_));
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
  SubtractReduced<Count>(border, x.topRows(n_));
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

  posterior.path_to_border.setZero(n_, k_);
  ForEachBlock([&](int first, int columns, int met) {
    for (int c = 0; c < met; ++c) {
      posterior.path_to_border.col(order_[c]).segment(first, columns) =
          -reduced_border_.row(c).segment(first, columns).transpose();
    }
  });
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
  const Eigen::VectorXd border = -ReducedTimes<1>(y);
  Eigen::VectorXd own = border.head(own_);
  own_factor_.triangularView<Eigen::Lower>().solveInPlace(own);
  variance += own.squaredNorm();
  own_factor_.transpose().triangularView<Eigen::Upper>().solveInPlace(own);
  return {variance, border.tail(k_ - own_) - own_to_shared_.transpose() * own};
}

}  // namespace flocklift::internal
