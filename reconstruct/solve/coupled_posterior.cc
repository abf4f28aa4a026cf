// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the flock with forces does not know at its solution: of depths, and of its own errors, from
// which the noise is estimated.

#include <algorithm>
#include <cmath>

#include "reconstruct/solve/coupled_flock.h"
#include "reconstruct/solve/coupled_point.h"

namespace flocklift::internal {
namespace {

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

// Of three errors, each by itself.
Vec3d CoupledFlock::VarianceOf(const Rows& rows, const TimeSystem::Posterior& posterior) const {
  using Rows3 = Eigen::Matrix<double, 3, Eigen::Dynamic>;
  Rows3 border = Rows3::Zero(3, system_.border());
  for (std::size_t b = 0; b < rows.border.size(); ++b) {
    border.col(rows.border[b]) += rows.by_border.col(static_cast<Eigen::Index>(b));
  }
  std::array<Rows3, TimeSystem::kSpan> by;
  for (int c = 0; c < TimeSystem::kSpan; ++c) {
    const std::vector<int>& columns = rows.columns[Index(c)];
    if (columns.empty()) continue;
    by[Index(c)] = Rows3::Zero(3, system_.width(rows.first_time + c));
    for (std::size_t n = 0; n < columns.size(); ++n) {
      by[Index(c)].middleCols<3>(columns[n]) =
          rows.by[Index(c)].middleCols<3>(3 * static_cast<Eigen::Index>(n));
    }
    border.noalias() -= by[Index(c)] * posterior.to_border[Index(rows.first_time + c)];
  }
  Eigen::Vector3d variance = (border * posterior.border).cwiseProduct(border).rowwise().sum();
  for (int c = 0; c < TimeSystem::kSpan; ++c) {
    for (int d = 0; d <= c && by[Index(c)].size() > 0; ++d) {
      const Rows3& other = by[Index(c - d)];
      if (other.size() == 0) continue;
      const Eigen::MatrixXd& block = posterior.band[Index(rows.first_time + c)][Index(d)];
      variance +=
          (d == 0 ? 1 : 2) * (by[Index(c)] * block).cwiseProduct(other).rowwise().sum().eval();
    }
  }
  return {variance[0], variance[1], variance[2]};
}

double CoupledFlock::EstimateNoise() {
  Linearize();
  if (!system_.Factorise(0, 0)) return noise.sd;
  const TimeSystem::Posterior posterior = system_.Covariance();
  constexpr double kInterval = 0.5;  // between the errors that are looked at [s]
  constexpr double kLeastSeen = 0.05;
  const int stride = std::max(1, static_cast<int>(std::lround(kInterval / model_.knot_interval)));
  double squares = 0, variances = 0, count = 0;
  for (const int moving : moving_) {
    const std::size_t i = Index(moving);
    for (int k = 0; k < birds_[i].knots; k += stride) {
      const Vec3d variance = VarianceOf(RowsOf(i, k, 1, 0), posterior);
      for (int axis = 0; axis < 3; ++axis) {
        const double e = Component(lines_[first_line_[i] + Index(k)].error, axis);
        squares += RobustWeight(Term::kAcceleration, e / noise.sd) * e * e;
        variances += Component(variance, axis);
        ++count;
      }
    }
  }
  const double seen = std::max(kLeastSeen, 1 - variances / (count * noise.sd * noise.sd));
  return std::sqrt(squares / (count * seen));
}

CoupledFlock::DepthSds CoupledFlock::Depths() {
  Linearize();
  if (!system_.Factorise(0, 0)) return {};
  const TimeSystem::Posterior posterior = system_.Covariance();
  DepthSds sds;
  sds.at.resize(birds_.size());
  double rows = 0;
  for (const int i : moving_) rows += static_cast<double>(birds_[Index(i)].places.size());
  std::vector<Eigen::VectorXd> mean;
  for (int t = 0; t < system_.times(); ++t) {
    mean.push_back(Eigen::VectorXd::Zero(system_.width(t)));
  }
  for (const int moving : moving_) {
    const std::size_t i = Index(moving);
    for (const Bird::Place& place : birds_[i].places) {
      double variance = 0;
      Eigen::VectorXd border = Eigen::VectorXd::Zero(system_.border());
      const auto column = [&](int a) { return column_[i][Index(place.interval + a)] + 2; };
      for (int a = 0; a < TimeSystem::kSpan; ++a) {
        const std::size_t time = Index(birds_[i].first_knot + place.interval + a);
        const double weight = place.weights[Index(a)];
        mean[time][column(a)] += weight / rows;
        border -= weight * posterior.to_border[time].row(column(a)).transpose();
        for (int b = 0; b <= a; ++b) {
          variance += (a == b ? 1 : 2) * weight * place.weights[Index(b)] *
                      posterior.band[time][Index(a - b)](column(a), column(b));
        }
      }
      variance += border.dot(posterior.border * border);
      sds.at[i].push_back(std::sqrt(std::max(variance, 0.0)));
    }
  }
  sds.mean = std::sqrt(system_.Variance(mean));
  return sds;
}

}  // namespace flocklift::internal
