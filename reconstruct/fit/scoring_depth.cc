// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <Eigen/Dense>
#include <cmath>
#include <cstdint>

#include "reconstruct/fit/innovation_cost.h"
#include "reconstruct/fit/scoring.h"
#include "simulate/core/parallel_for.h"
#include "simulate/core/rng.h"

namespace flocklift::internal {
namespace {

constexpr Eigen::Index kExactProbes = 40;  // of a trace: so many errors are all looked at
constexpr Eigen::Index kProbes = 16;       // ... of more
constexpr std::uint64_t kProbeSeed = 1990;
constexpr double kProbeStep = 0.05;  // of depth errors, in their own sd
constexpr double kObserved = 0.3;    // of an unknown's sd, for the score's slope

}  // namespace

void Scoring::AddDepthErrors(const FilterSweep& base) {
  const std::span<const double> z = std::span(phi_).subspan(own_);
  const auto errors = static_cast<Eigen::Index>(z.size());
  Eigen::VectorXd gradient = Eigen::Map<const Eigen::VectorXd>(z.data(), errors);  // ~ N(0, 1)
  Eigen::MatrixXd second = Eigen::MatrixXd::Identity(errors, errors);
  paths_->AddVolume(z, {gradient.data(), z.size()}, {second.data(), z.size() * z.size()});
  score_.tail(errors) += gradient;
  information_.bottomRightCorner(errors, errors) += second;
  const Eigen::LLT<Eigen::MatrixXd> llt(information_.bottomRightCorner(errors, errors));
  std::vector<Eigen::VectorXd> probes;
  Rng rng(kProbeSeed);
  const Eigen::Index count = errors <= kExactProbes ? errors : kProbes;
  for (Eigen::Index k = 0; k < count; ++k) {
    Eigen::VectorXd signs =
        std::sqrt(static_cast<double>(count)) * Eigen::VectorXd::Unit(errors, k);
    if (count < errors) {
      for (double& sign : signs) sign = rng.Below(2) == 0 ? -1 : 1;
    }
    probes.push_back(llt.matrixU().solve(signs));
  }
  // |S^-1/2 eps_u|^2 of every probe u, at phi_ and where one unknown is moved.
  Eigen::MatrixXd squares(count, static_cast<Eigen::Index>(own_) + 1);
  ParallelFor(options_.threads, 0, squares.size(), 1, [&](std::int64_t first, std::int64_t last) {
    for (auto at = static_cast<Eigen::Index>(first); at < static_cast<Eigen::Index>(last); ++at) {
      const Eigen::Index p = at / count, k = at % count;
      std::vector<double> phi = phi_;
      if (p > 0) {
        phi[static_cast<std::size_t>(p) - 1] += differences_[static_cast<std::size_t>(p) - 1];
      }
      for (Eigen::Index z = 0; z < errors; ++z) {
        phi[own_ + static_cast<std::size_t>(z)] +=
            kProbeStep * probes[static_cast<std::size_t>(k)][z];
      }
      const FilterSweep probed = SweepAt(phi);
      const FilterSweep& from = p > 0 ? moved_[static_cast<std::size_t>(p) - 1] : base;
      double sum = 0;
      for (std::size_t i = 0; i < from.innovations.size(); ++i) {
        const Eigen::Vector3d slope =
            (ValueOf(probed.innovations[i]) - ValueOf(from.innovations[i])) / kProbeStep;
        sum += slope.dot(CovarianceOf(from.innovations[i]).llt().solve(slope));
      }
      squares(k, p) = sum;
    }
  });
  determinant_ = Eigen::VectorXd::Zero(score_.size());
  for (std::size_t p = 0; p < own_; ++p) {
    const auto at = static_cast<Eigen::Index>(p);
    determinant_[at] = 0.5 * (squares.col(at + 1) - squares.col(0)).mean() / differences_[p];
  }
  score_ += determinant_;
}

void Scoring::ObserveInformation() {
  const Eigen::VectorXd score = score_;
  const Eigen::MatrixXd expected = information_, covariance = covariance_;
  const std::vector<double> phi = phi_;
  Eigen::MatrixXd observed = information_;
  for (std::size_t p = 0; p < own_; ++p) {
    const auto at = static_cast<Eigen::Index>(p);
    if (!free_[p] || !(covariance(at, at) > 0)) continue;
    const double difference = kObserved * std::sqrt(covariance(at, at));
    phi_[p] += difference;
    Linearize(SweepAt(phi_));
    observed.col(at) = (score_ - score) / difference;
    phi_ = phi;
  }
  const auto own = static_cast<Eigen::Index>(own_);
  const Eigen::MatrixXd corner = observed.topLeftCorner(own, own);
  observed.topLeftCorner(own, own) = 0.5 * (corner + corner.transpose());
  observed.topRightCorner(own, observed.cols() - own) =
      observed.bottomLeftCorner(observed.rows() - own, own).transpose();
  score_ = score;
  information_ = observed;
  const std::vector<Eigen::Index> used = Used();
  if (Eigen::LLT<Eigen::MatrixXd>(observed(used, used)).info() != Eigen::Success) {
    information_ = expected;
  }
  Step();
}

}  // namespace flocklift::internal
