// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/time_system.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace flocklift::internal {

using Eigen::Lower;
using Eigen::MatrixXd;
using Eigen::OnTheRight;
using Eigen::VectorXd;

TimeSystem::TimeSystem(const std::vector<int>& widths, int border)
    : band_(widths.size()),
      factor_(widths.size()),
      corner_(MatrixXd::Zero(border, border)),
      border_gradient_(VectorXd::Zero(border)) {
  for (std::size_t t = 0; t < widths.size(); ++t) {
    for (std::size_t d = 0; d < kSpan && d <= t; ++d) {
      band_[t][d] = MatrixXd::Zero(widths[t], widths[t - d]);
    }
    to_border_.push_back(MatrixXd::Zero(widths[t], border));
    gradient_.push_back(VectorXd::Zero(widths[t]));
  }
  reduced_border_ = to_border_;
  reduced_gradient_ = gradient_;
}

void TimeSystem::SetZero() {
  for (auto& row : band_) {
    for (MatrixXd& block : row) block.setZero();
  }
  for (MatrixXd& block : to_border_) block.setZero();
  for (VectorXd& part : gradient_) part.setZero();
  corner_.setZero();
  border_gradient_.setZero();
}

bool TimeSystem::Factorise(double damping, double depth_metric) {
  for (int t = 0; t < times(); ++t) {
    auto& row = factor_[Index(t)];
    row = band_[Index(t)];
    const int before = std::min(t, kSpan - 1);
    for (int d = before; d >= 1; --d) {
      MatrixXd& block = row[Index(d)];
      const auto& other = factor_[Index(t - d)];
      for (int e = d + 1; e <= before; ++e) {
        block.noalias() -= row[Index(e)] * other[Index(e - d)].transpose();
      }
      other[0].triangularView<Lower>().transpose().solveInPlace<OnTheRight>(block);
    }
    MatrixXd& diagonal = row[0];
    for (Eigen::Index i = 0; i < diagonal.rows(); ++i) {
      diagonal(i, i) += damping * (i % 3 == 2 ? depth_metric : diagonal(i, i));
    }
    MatrixXd& border = reduced_border_[Index(t)];
    VectorXd& gradient = reduced_gradient_[Index(t)];
    border = to_border_[Index(t)];
    gradient = gradient_[Index(t)];
    for (int d = 1; d <= before; ++d) {
      const MatrixXd& block = row[Index(d)];
      diagonal.selfadjointView<Lower>().rankUpdate(block, -1);
      border.noalias() -= block * reduced_border_[Index(t - d)];
      gradient.noalias() -= block * reduced_gradient_[Index(t - d)];
    }
    Eigen::LLT<Eigen::Ref<MatrixXd>> llt(diagonal);
    if (llt.info() != Eigen::Success) return false;
    diagonal.triangularView<Lower>().solveInPlace(border);
    diagonal.triangularView<Lower>().solveInPlace(gradient);
  }
  corner_factor_ = corner_;
  corner_factor_.diagonal() *= 1 + damping;
  VectorXd gradient = border_gradient_;
  for (int t = 0; t < times(); ++t) {
    const MatrixXd& border = reduced_border_[Index(t)];
    corner_factor_.noalias() -= border.transpose() * border;
    gradient.noalias() -= border.transpose() * reduced_gradient_[Index(t)];
  }
  const Eigen::LLT<MatrixXd> llt(corner_factor_);
  if (llt.info() != Eigen::Success) return false;
  border_step_ = -llt.solve(gradient);
  corner_factor_ = llt.matrixL();
  return border_step_.allFinite();
}

TimeSystem::Step TimeSystem::Solve() const {
  Step step{std::vector<VectorXd>(band_.size()), border_step_};
  for (int t = times() - 1; t >= 0; --t) {
    VectorXd x = -reduced_gradient_[Index(t)] - reduced_border_[Index(t)] * border_step_;
    for (int d = 1; d < kSpan && t + d < times(); ++d) {
      x.noalias() -= factor_[Index(t + d)][Index(d)].transpose() * step.at[Index(t + d)];
    }
    factor_[Index(t)][0].triangularView<Lower>().transpose().solveInPlace(x);
    step.at[Index(t)] = x;
  }
  return step;
}

TimeSystem::Posterior TimeSystem::Covariance() const {
  Posterior posterior{std::vector<std::array<MatrixXd, kSpan>>(band_.size()),
                      std::vector<MatrixXd>(band_.size()),
                      {}};
  const auto n = corner_.rows();
  MatrixXd inverse = MatrixXd::Identity(n, n);
  corner_factor_.triangularView<Lower>().solveInPlace(inverse);
  posterior.border = inverse.transpose() * inverse;
  // Block (s, t) of the inverse, s >= t.
  const auto block = [&posterior](int s, int t) -> const MatrixXd& {
    return posterior.band[Index(s)][Index(s - t)];
  };
  for (int t = times() - 1; t >= 0; --t) {
    const MatrixXd& diagonal = factor_[Index(t)][0];
    const int after = std::min(times() - 1 - t, kSpan - 1);
    // L(t + d, t) L(t, t)^-1
    std::array<MatrixXd, kSpan> ratio;
    for (int d = 1; d <= after; ++d) {
      ratio[Index(d)] = factor_[Index(t + d)][Index(d)];
      diagonal.triangularView<Lower>().solveInPlace<OnTheRight>(ratio[Index(d)]);
    }
    MatrixXd own = MatrixXd::Identity(diagonal.rows(), diagonal.rows());
    diagonal.triangularView<Lower>().solveInPlace(own);
    own = (own.transpose() * own).eval();
    MatrixXd border = reduced_border_[Index(t)];
    for (int d = 1; d <= after; ++d) {
      border.noalias() -=
          factor_[Index(t + d)][Index(d)].transpose() * posterior.to_border[Index(t + d)];
      MatrixXd across = MatrixXd::Zero(ratio[Index(d)].rows(), diagonal.rows());
      for (int e = 1; e <= after; ++e) {
        if (e <= d) {
          across.noalias() -= block(t + d, t + e) * ratio[Index(e)];
        } else {
          across.noalias() -= block(t + e, t + d).transpose() * ratio[Index(e)];
        }
      }
      posterior.band[Index(t + d)][Index(d)] = across;
    }
    for (int d = 1; d <= after; ++d) {
      own.noalias() -= ratio[Index(d)].transpose() * block(t + d, t);
    }
    // Rounding that is not symmetric would grow.
    posterior.band[Index(t)][0] = 0.5 * (own + own.transpose());
    diagonal.triangularView<Lower>().transpose().solveInPlace(border);
    posterior.to_border[Index(t)] = border;
  }
  return posterior;
}

double TimeSystem::Variance(const std::vector<VectorXd>& weights) const {
  std::vector<VectorXd> reduced = weights;
  double variance = 0;
  VectorXd border = VectorXd::Zero(corner_.rows());
  for (int t = 0; t < times(); ++t) {
    VectorXd& x = reduced[Index(t)];
    for (int d = 1; d <= std::min(t, kSpan - 1); ++d) {
      x.noalias() -= factor_[Index(t)][Index(d)] * reduced[Index(t - d)];
    }
    factor_[Index(t)][0].triangularView<Lower>().solveInPlace(x);
    variance += x.squaredNorm();
    border.noalias() += reduced_border_[Index(t)].transpose() * x;
  }
  corner_factor_.triangularView<Lower>().solveInPlace(border);
  return variance + border.squaredNorm();
}

}  // namespace flocklift::internal
