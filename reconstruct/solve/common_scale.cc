// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/common_scale.h"

#include <cmath>

namespace flocklift::internal {
namespace {

// By how much the flock's unknowns change with the logarithm of the factor.
Eigen::VectorXd SharedGrowth(const BatchModel& model) {
  Eigen::VectorXd growth = Eigen::VectorXd::Zero(model.shared());
  growth[kFlockLogSpeed] = growth[kSizeRatio] = 1;
  growth.segment(model.depth.first, model.depth.size()).setOnes();
  return growth;
}

// By how much a residual does.
double GrowthOf(const ResidualRow& row, const Eigen::VectorXd& shared_growth) {
  double sum = 0;
  for (std::size_t k = 2; k < row.path.size(); k += 3) sum += row.path[k];
  for (std::size_t k = 0; k < static_cast<std::size_t>(row.border_count); ++k) {
    const auto [index, slope] = row.border[k];
    if (index >= kOwnUnknowns) sum += slope * shared_growth[index - kOwnUnknowns];
    if (index == kOwnLogSpeed) sum += slope;
  }
  return sum;
}

}  // namespace

void Grow(double log_factor, const BatchModel& model, std::vector<Bird>* birds,
          Eigen::VectorXd* shared) {
  for (Bird& bird : *birds) {
    for (std::size_t k = 2; k < bird.path.size(); k += 3) bird.path[k] += log_factor;
    bird.own[kOwnLogSpeed] += log_factor;
  }
  *shared += log_factor * SharedGrowth(model);
}

void FindCommonScale(const BatchModel& model, std::vector<Bird>* birds, Eigen::VectorXd* shared) {
  constexpr int kSteps = 3;  // of Gauss and Newton; the terms are all but linear
  const Eigen::VectorXd growth = SharedGrowth(model);
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::Index size = model.shared();
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(size);
    SharedPriors(model, *shared, &matrix, &gradient);
    double curvature = growth.dot(matrix * growth), slope = growth.dot(gradient);
    for (const Bird& bird : *birds) {
      const auto add = [&](Term term, const ResidualRow& row) {
        const double by_growth = GrowthOf(row, growth);
        const double weight = RobustWeight(term, row.residual);
        curvature += weight * by_growth * by_growth;
        slope += weight * by_growth * row.residual;
      };
      ForEachRow(model, bird, *shared, true, add, RowKind::kNoAccelerations);
    }
    const double grown = -slope / curvature;
    if (!std::isfinite(grown)) return;
    Grow(grown, model, birds, shared);
  }
}

}  // namespace flocklift::internal
