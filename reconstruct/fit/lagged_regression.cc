// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/lagged_regression.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMap = Eigen::Map<const VectorXd>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSingular = 1e-9;  // of the scaled moment matrix's largest singular value

RowMap Features(const RegressionRows& rows, std::size_t e) {
  return {rows.features.data() + e * static_cast<std::size_t>(rows.terms), rows.terms};
}
RowMap Instruments(const RegressionRows& rows, std::size_t e) {
  return {rows.instruments.data() + e * static_cast<std::size_t>(rows.terms), rows.terms};
}

// The long-run covariance of the scores, summed over time: T times that of their mean.
MatrixXd LongRunCovariance(const MatrixXd& scores, int cosines) {
  const Eigen::Index times = scores.cols();
  MatrixXd sum = MatrixXd::Zero(scores.rows(), scores.rows());
  for (int j = 1; j <= cosines; ++j) {
    VectorXd projection = VectorXd::Zero(scores.rows());
    for (Eigen::Index t = 0; t < times; ++t) {
      const double angle = std::numbers::pi * j * (static_cast<double>(t) + 0.5);
      projection += std::cos(angle / static_cast<double>(times)) * scores.col(t);
    }
    sum += 2.0 * projection * projection.transpose();
  }
  return sum / cosines;
}

}  // namespace

double StudentQuantile975(int nu) {
  const double z = 1.959963985, n = nu;
  const double z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n);
}

RegressionResult SolveRegression(const RegressionRows& rows) {
  const int p = rows.terms;
  const std::size_t count = rows.size();
  const auto np = static_cast<std::size_t>(p);
  Check(p > 0 && rows.features.size() == count * np && rows.instruments.size() == count * np &&
            rows.weight.size() == count && rows.time.size() == count && rows.group.size() == count,
        "the arrays of a regression have different lengths");
  RegressionResult result;
  result.estimate.assign(np, 0.0);
  result.sd.assign(np, kInfinity);
  result.correlation.assign(np * np, 0.0);
  for (std::size_t k = 0; k < np; ++k) result.correlation[k * np + k] = 1.0;
  result.feature_rms.assign(np, 0.0);
  result.condition = kInfinity;
  if (count < 10 * np) {
    result.status = RegressionStatus::kTooFewRows;
    return result;
  }
  const int first_time = rows.time.front();
  const int times = rows.time.back() - first_time + 1;
  if (times < kMinTimes) {
    result.status = RegressionStatus::kTooFewTimes;
    return result;
  }

  MatrixXd moment = MatrixXd::Zero(p, p);
  VectorXd right = VectorXd::Zero(p), squares = VectorXd::Zero(p), squares_z = VectorXd::Zero(p);
  double weight = 0;
  for (std::size_t e = 0; e < count; ++e) {
    const double w = rows.weight[e];
    const RowMap x = Features(rows, e), z = Instruments(rows, e);
    moment.noalias() += w * z * x.transpose();
    right += w * rows.response[e] * z;
    squares += w * x.cwiseAbs2();
    squares_z += w * z.cwiseAbs2();
    weight += w;
  }
  const VectorXd x_rms = (squares / weight).cwiseSqrt(), z_rms = (squares_z / weight).cwiseSqrt();
  for (int k = 0; k < p; ++k) result.feature_rms[static_cast<std::size_t>(k)] = x_rms[k];

  // Terms scaled to unit rms; a term that never acts has scale 0 and drops out.
  const auto inverse = [](double rms) { return rms > 1e-12 ? 1.0 / rms : 0.0; };
  const VectorXd x_scale = x_rms.unaryExpr(inverse), z_scale = z_rms.unaryExpr(inverse);
  const MatrixXd scaled = z_scale.asDiagonal() * moment * x_scale.asDiagonal() / weight;
  const Eigen::JacobiSVD<MatrixXd> svd(scaled, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const VectorXd& singular = svd.singularValues();
  VectorXd inverted = VectorXd::Zero(p);
  VectorXd unseen = VectorXd::Zero(p);  // share of each term in directions without information
  for (int k = 0; k < p; ++k) {
    if (singular[k] > kSingular * std::max(singular[0], kSingular)) {
      inverted[k] = 1.0 / singular[k];
    } else {
      unseen += svd.matrixV().col(k).cwiseAbs2();
    }
  }
  result.condition = inverted[p - 1] > 0 ? singular[0] * inverted[p - 1] : kInfinity;
  const MatrixXd solve = x_scale.asDiagonal() * svd.matrixV() * inverted.asDiagonal() *
                         svd.matrixU().transpose() * z_scale.asDiagonal() / weight;
  const VectorXd theta = solve * right;
  for (int k = 0; k < p; ++k) result.estimate[static_cast<std::size_t>(k)] = theta[k];

  // Scores per frame.
  MatrixXd scores = MatrixXd::Zero(p, times);
  MatrixXd group_scores =
      MatrixXd::Zero(p, *std::max_element(rows.group.begin(), rows.group.end()) + 1);
  double squares_u = 0;
  for (std::size_t e = 0; e < count; ++e) {
    const double u = rows.response[e] - Features(rows, e).dot(theta);
    const VectorXd score = rows.weight[e] * u * Instruments(rows, e);
    scores.col(rows.time[e] - first_time) += score;
    group_scores.col(rows.group[e]) += score;
    squares_u += rows.weight[e] * u * u;
  }
  result.residual_sd = std::sqrt(squares_u / weight);
  result.cosines = std::clamp(static_cast<int>(0.4 * std::pow(times, 2.0 / 3.0)), 4, times - 1);
  const auto equations = static_cast<double>(count);
  const auto covariance_of = [&](const MatrixXd& sum, int freedom) {
    const double widen = StudentQuantile975(freedom) / 1.959963985;
    return MatrixXd(solve * sum * solve.transpose() *
                    (equations / (equations - p) * widen * widen));
  };
  const MatrixXd covariance =
      covariance_of(LongRunCovariance(scores, result.cosines), result.cosines);
  VectorXd variance = covariance.diagonal();
  const auto groups = static_cast<int>((group_scores.colwise().squaredNorm().array() > 0).count());
  if (groups >= kMinGroups) {
    const MatrixXd by_group = covariance_of(group_scores * group_scores.transpose(), groups - 1);
    variance = variance.cwiseMax(by_group.diagonal());
  }
  for (int k = 0; k < p; ++k) {
    const auto row = static_cast<std::size_t>(k);
    if (unseen[k] > 1e-6 || x_scale[k] == 0 || z_scale[k] == 0) continue;
    result.sd[row] = std::sqrt(variance[k]);
  }
  for (std::size_t i = 0; i < np; ++i) {
    for (std::size_t j = 0; j < np; ++j) {
      const auto ei = static_cast<Eigen::Index>(i), ej = static_cast<Eigen::Index>(j);
      const double scale = std::sqrt(covariance(ei, ei) * covariance(ej, ej));
      if (i != j && scale > 0 && std::isfinite(result.sd[i]) && std::isfinite(result.sd[j])) {
        result.correlation[i * np + j] = std::clamp(covariance(ei, ej) / scale, -1.0, 1.0);
      }
    }
  }
  return result;
}

}  // namespace flocklift
