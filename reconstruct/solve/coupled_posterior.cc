// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the flock with forces does not know at its solution: of depths, and of its own errors, from
// which the noise is estimated. By draws from the posterior N(0, M^-1): every whitened residual is
// moved by a normal number and the system solved for what that does to the unknowns,
//   M x = J^T W^1/2 e,   e ~ N(0, 1)
// (Papandreou and Yuille, "Gaussian sampling by local perturbations", 2010). The numbers are
// counted, so that the same come up each time.

#include <algorithm>
#include <cmath>

#include "reconstruct/solve/coupled_flock.h"
#include "reconstruct/solve/coupled_point.h"
#include "simulate/core/rng.h"

namespace flocklift::internal {
namespace {

// Draws need not be more exact than their number makes variances. What animals have in common is
// solved for last; errors of single ones, from which the noise is estimated, hardly depend on it.
constexpr GradientStop kDepthStop{.share = 1e-3, .most = 200};
constexpr GradientStop kNoiseStop{.share = 5e-3, .most = 200};
constexpr std::uint64_t kNoiseSeed = 1, kDepthSeed = 2;

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

Columns<CoupledFlock::kSamples> CoupledFlock::Draw(std::uint64_t seed,
                                                   const GradientStop& stop) const {
  using Row = Eigen::Matrix<double, 1, kSamples>;
  Columns<kSamples> pulled = Columns<kSamples>::Zero(gradient_.size(), kSamples);
  Errors<kSamples> errors(lines_.size());
  const MarkovWhitening whitening = Whitening();
  const auto normals = [](Rng& rng) {
    Row row;
    for (double& x : row) x = rng.Normal();
    return row;
  };
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    const Bird& bird = birds_[i];
    Rng rng(seed, i);
    const auto pull = [&](Term term, const ResidualRow& row) {
      const Row e = std::sqrt(RobustWeight(term, row.residual)) * normals(rng);
      const int count = std::min<int>(ArrowSystem::kBand, bird.unknowns() - row.first);
      for (int a = 0; a < count; ++a) {
        pulled.row(place_[i] + row.first + a) += row.path[Index(a)] * e;
      }
      for (int c = 0; c < row.border_count; ++c) {
        const auto [index, derivative] = row.border[Index(c)];
        const Eigen::Index at = index < kOwnUnknowns ? place_[i] + bird.unknowns() + index
                                                     : place_.back() + index - kOwnUnknowns;
        pulled.row(at) += derivative * e;
      }
    };
    ForEachRow(model_, bird, shared_, true, pull, RowKind::kNoAccelerations);
    for (int k = 0; k < bird.knots; ++k) {
      const std::size_t at = LineOf(i, k);
      for (int axis = 0; axis < 3; ++axis) {
        errors[at].row(axis) = whitening.At(k) * std::sqrt(lines_[at].weight[axis]) * normals(rng);
      }
      if (k > 0) errors[LineOf(i, k - 1)] -= whitening.rho * errors[at];
    }
  }
  PullOwn<kSamples>(errors, &pulled);
  PullHeard<kSamples>(errors, &pulled);
  const Eigen::LLT<Eigen::MatrixXd> priors(priors_);
  Columns<kSamples> e(border(), kSamples);
  Rng rng(seed, birds_.size());
  for (Eigen::Index k = 0; k < border(); ++k) e.row(k) = normals(rng);
  pulled.bottomRows(border()) += priors.matrixL() * e;
  return Solve<kSamples>(pulled, stop);
}

std::optional<double> CoupledFlock::EstimateNoise() {
  Linearize();
  if (!Factorise(0)) return {};
  Errors<kSamples> changes, heard;
  ChangesOf<kSamples>(Draw(kNoiseSeed, kNoiseStop), &changes, &heard);
  constexpr double kInterval = 0.5;  // between the errors that are looked at [s]
  constexpr double kLeastSeen = 0.05;
  const int stride = std::max(1, static_cast<int>(std::lround(kInterval / model_.knot_interval)));
  double squares = 0, variances = 0, count = 0;
  for (std::size_t i = 0; i < birds_.size(); ++i) {
    for (int k = 0; k < birds_[i].knots; k += stride) {
      const std::size_t at = LineOf(i, k);
      variances += (changes[at] + heard[at]).squaredNorm() / kSamples;
      for (int axis = 0; axis < 3; ++axis) {
        const double e = Component(lines_[at].error, axis);
        squares += RobustWeight(Term::kAcceleration, e / noise.sd) * e * e;
        ++count;
      }
    }
  }
  const double seen = std::max(kLeastSeen, 1 - variances / (count * noise.sd * noise.sd));
  const double sd = std::sqrt(squares / (count * seen));
  if (!std::isfinite(sd)) return {};
  return sd;
}

CoupledFlock::DepthSds CoupledFlock::Depths(int draws) {
  Linearize();
  if (!Factorise(0)) return {};
  double rows = 0;
  for (const Bird& bird : birds_) rows += static_cast<double>(bird.places.size());
  DepthSds sds;
  sds.at.resize(birds_.size());
  double of_mean = 0;
  using Row = Eigen::Matrix<double, 1, kSamples>;
  for (int draw = 0; draw < draws; ++draw) {
    const Columns<kSamples> x = Draw(kDepthSeed + static_cast<std::uint64_t>(draw), kDepthStop);
    const auto depth = [&](std::size_t i, const Bird::Place& place) {
      Row sum = Row::Zero();
      for (int a = 0; a < 4; ++a) {
        sum +=
            place.weights[Index(a)] * x.row(place_[i] + 3 * Eigen::Index{place.interval + a} + 2);
      }
      return sum;
    };
    Row mean = Row::Zero();
    for (std::size_t i = 0; i < birds_.size(); ++i) {
      sds.at[i].resize(birds_[i].places.size());
      for (const Bird::Place& place : birds_[i].places) mean += depth(i, place) / rows;
    }
    for (std::size_t i = 0; i < birds_.size(); ++i) {
      for (std::size_t k = 0; k < sds.at[i].size(); ++k) {
        sds.at[i][k] += (depth(i, birds_[i].places[k]) - mean).squaredNorm() / (draws * kSamples);
      }
    }
    of_mean += mean.squaredNorm() / (draws * kSamples);
  }
  for (std::vector<double>& animal : sds.at) {
    for (double& sd : animal) sd = std::sqrt(sd);
  }
  sds.mean = std::sqrt(of_mean);
  return sds;
}

}  // namespace flocklift::internal
