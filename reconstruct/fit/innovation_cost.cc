// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/innovation_cost.h"

#include <Eigen/Dense>
#include <cmath>
#include <cstddef>

namespace flocklift::internal {
namespace {

using Matrix3 = Eigen::Matrix3d;
using Vector3 = Eigen::Vector3d;

double CostOf(const Vector3& value, const Matrix3& covariance) {
  const Eigen::LLT<Matrix3> llt(covariance);
  const Vector3 white = llt.matrixL().solve(value);
  return 2 * std::log(llt.matrixL().toDenseMatrix().diagonal().prod()) + white.squaredNorm();
}

}  // namespace

Matrix3 CovarianceOf(const Innovation& i) {
  const auto& c = i.covariance;
  Matrix3 s;
  s << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
  return s;
}

double CostBeside(const FilterSweep& sweep, const FilterSweep& next) {
  double cost = next.cost;
  for (std::size_t k = 0; k < sweep.innovations.size(); ++k) {
    if (!sweep.innovations[k].is_limited) continue;
    const Vector3 value = ValueOf(next.innovations[k]);
    cost += CostOf(value, CovarianceOf(sweep.innovations[k])) -
            CostOf(value, CovarianceOf(next.innovations[k]));
  }
  return cost;
}

double MeanSquareOf(const FilterSweep& sweep) {
  double sum = 0, count = 0;
  for (const Innovation& innovation : sweep.innovations) {
    if (innovation.is_limited) continue;
    const Eigen::LLT<Matrix3> llt(CovarianceOf(innovation));
    sum += llt.matrixL().solve(ValueOf(innovation)).squaredNorm();
    count += 3;
  }
  return count > 0 ? sum / count : 1;
}

}  // namespace flocklift::internal
