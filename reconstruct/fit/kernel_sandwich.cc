// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/kernel_sandwich.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstdint>

#include "simulate/core/parallel_for.h"

namespace flocklift {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Of one run, of which nothing is known where an animal of it has no velocity.
VectorXd ScoreOf(const KernelDesign& design, const ObservedFlock& flock, const KernelRun& run,
                 const KernelModes& modes, const KernelEvidence& evidence) {
  const Index p = evidence.coefficients.size();
  const Eigen::ArrayXd variance =
      evidence.position_variance * modes.lambda.array() + evidence.diffusion;
  MatrixXd features = MatrixXd::Zero(3 * run.frames, p), positions(run.frames, 3);
  std::vector<Vec3d> terms;
  const Vec3d& origin = flock.Position(run.animal, run.first);
  for (int k = 0; k < run.frames; ++k) {
    const Vec3d x = flock.Position(run.animal, run.first + k) - origin;
    positions.row(k) << x.x, x.y, x.z;
    if (k < design.order - 1 || k > run.frames - design.order) continue;
    if (!KernelTerms(design, flock, flock, run.animal, run.first + k, &terms, nullptr)) {
      return VectorXd::Zero(p);
    }
    for (Index t = 0; t < p; ++t) {
      const Vec3d& term = terms[static_cast<std::size_t>(t)];
      features(k, t) = term.x;
      features(run.frames + k, t) = term.y;
      features(2 * run.frames + k, t) = term.z;
    }
  }
  VectorXd score = VectorXd::Zero(p);
  for (int c = 0; c < 3; ++c) {
    if (!design.coordinates[static_cast<std::size_t>(c)]) continue;
    const auto x = features.middleRows(c * run.frames, run.frames);
    const VectorXd drive = x * evidence.coefficients;
    const VectorXd residual = modes.difference * positions.col(c) - modes.average * drive;
    const VectorXd weighted = residual.array() / variance;
    const VectorXd by_frame = modes.average.transpose() * weighted;
    score += x.transpose() * by_frame;
  }
  return score;
}

MatrixXd Larger(const MatrixXd& v, const MatrixXd& other) {
  const Eigen::LLT<MatrixXd> factor(v);
  if (factor.info() != Eigen::Success) return v + other;  // no smaller than either
  const auto lower = factor.matrixL();
  const MatrixXd half_way = lower.solve(other).transpose();
  const MatrixXd ratio = lower.solve(half_way);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(0.5 * (ratio + ratio.transpose()));
  const MatrixXd half = lower * eigen.eigenvectors();
  return half * eigen.eigenvalues().cwiseMax(1.0).asDiagonal() * half.transpose();
}

}  // namespace

MatrixXd KernelSandwich(const KernelDesign& design, const std::vector<ObservedFlock>& flocks,
                        const std::map<int, KernelModes>& modes, const KernelEvidence& evidence,
                        int threads) {
  const MatrixXd& v = evidence.covariance;
  if (flocks.size() < 2) return v;
  const auto n = static_cast<Index>(flocks.size());
  const std::vector<KernelRun> runs = KernelRuns(design, flocks);
  MatrixXd scores = MatrixXd::Zero(v.rows(), n);
  ParallelFor(threads, 0, n, 1, [&](std::int64_t f, std::int64_t) {
    const auto flock = static_cast<std::size_t>(f);
    const auto last = std::ranges::upper_bound(runs, flock, {}, &KernelRun::flock);
    for (auto run = std::ranges::lower_bound(runs, flock, {}, &KernelRun::flock); run != last;
         ++run) {
      scores.col(f) += ScoreOf(design, flocks[flock], *run, modes.at(run->frames), evidence);
    }
  });
  const VectorXd mean = scores.rowwise().mean();
  const MatrixXd moved = v * (scores.colwise() - mean);
  const double of_sample = static_cast<double>(n) / static_cast<double>(n - 1);
  return Larger(v, of_sample * moved * moved.transpose());
}

}  // namespace flocklift
