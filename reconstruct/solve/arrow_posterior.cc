// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>

#include "reconstruct/solve/arrow_system.h"

namespace flocklift::internal {

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
