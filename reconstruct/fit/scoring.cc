// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/scoring.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "reconstruct/fit/innovation_cost.h"
#include "reconstruct/fit/state_transition.h"
#include "simulate/core/parallel_for.h"

namespace flocklift::internal {
namespace {

using Matrix3 = Eigen::Matrix3d;
using Vector3 = Eigen::Vector3d;
using Vector9 = Eigen::Matrix<double, 9, 1>;

constexpr double kFirstDifference = 1e-6;  // of an unknown, before its sd is known
constexpr double kDifference = 0.01;       // ... of its sd, afterwards
constexpr double kSmallVariance = 1e-3;    // s0^2, of how far the noise moves in a frame
constexpr double kNothing = 1e-12;         // an information below this share of the others'
constexpr double kUnseen = 1e-6;           // ... of a parameter's own, beside the others
constexpr int kHalvings = 12;
constexpr double kFarTooLarge = 0.1;  // innovations are so much of their covariances: all shrinks
constexpr int kShrinkings = 10;

}  // namespace

Scoring::Scoring(const StateSpaceOptions& options, const ProcessModel& model,
                 const std::vector<double>& start, const FilterInput& input,
                 const DepthPaths* paths)
    : options_(options),
      model_(model),
      input_(input),
      paths_(paths),
      p_(start.size()),
      own_(start.size() + 2) {
  phi_ = start;
  // Second differences of integrated white noise and of position noise have variances
  // 2/3 q dt^3 + 6 s^2 and covariances over a frame q dt^3 / 6 - 4 s^2.
  const auto& moment = input.second_differences();
  const double moved = std::max((moment[0] + 1.5 * moment[1]) / (2.0 / 3 + 0.25),
                                0.05 * moment[0]);  // q dt^3
  const double variance = std::max((moment[0] - moved * 2 / 3) / 6, 1e-3 * moved);
  smallest_ = kSmallVariance * moved;
  phi_.push_back(std::log(moved / std::pow(input.dt(), 3)));
  lowest_ = std::log(smallest_);
  phi_.push_back(std::log(variance + smallest_));
  differences_.assign(phi_.size(), kFirstDifference);
  lowest_q_ = std::log(kSmallVariance * input.rounding().velocity *
                       StepsAFrame(options.filter.substeps) / input.dt());
  if (paths_ == nullptr) return;
  phi_.resize(phi_.size() + paths_->size(), 0);
  differences_.resize(phi_.size(), kDifference);
}

StateSpaceFit Scoring::Run() {
  StateSpaceFit fit;
  FilterSweep sweep = SweepAt(phi_);
  fit.innovations = sweep.innovations.size();
  if (3 * sweep.innovations.size() < 10 * phi_.size() || !std::isfinite(sweep.cost)) {
    fit.status = StateSpaceStatus::kTooFew;
    return fit;
  }
  fit.status = StateSpaceStatus::kNotConverged;
  for (fit.rounds = 1; fit.rounds <= options_.rounds; ++fit.rounds) {
    Shrink(&sweep);
    Linearize(sweep);
    const Eigen::VectorXd step = Step();
    const bool small = Largest(step) < options_.accuracy;
    if (!Walk(step, &sweep) || small) {
      fit.status =
          small || Largest(step) < 0.3 ? StateSpaceStatus::kOk : StateSpaceStatus::kNotConverged;
      break;
    }
  }
  if (paths_ != nullptr) ObserveInformation();
  Describe(sweep, &fit);
  return fit;
}

void Scoring::Shrink(FilterSweep* sweep) {
  for (int k = 0; k < kShrinkings; ++k) {
    const double square = MeanSquareOf(*sweep);
    const double change = std::max(std::log(square), lowest_q_ - phi_[p_]);
    if (!(square < kFarTooLarge && change < 0)) return;
    phi_[p_] += change;
    phi_[p_ + 1] += change;
    lowest_ += change;
    smallest_ = std::exp(lowest_);
    *sweep = SweepAt(phi_, std::move(*sweep));
  }
}

std::vector<HeldScore> Scoring::Score(const StateSpaceFit& fit, std::size_t first_held) {
  phi_[p_] = std::log(2 * fit.noise.diffusion);
  phi_[p_ + 1] = std::max(lowest_, std::log(fit.noise.position_variance + smallest_));
  std::copy(fit.depth_errors.begin(), fit.depth_errors.end(),
            phi_.begin() + static_cast<std::ptrdiff_t>(own_));
  const FilterSweep sweep = SweepAt(phi_);
  Linearize(sweep);
  Step();  // by differences of fitting size
  Linearize(sweep);
  Step();
  std::vector<Eigen::Index> others, held;
  for (const Eigen::Index p : Used()) {
    const auto at = static_cast<std::size_t>(p);
    (at >= first_held && at < p_ ? held : others).push_back(p);
  }
  // Of what the others cannot do instead.
  const Eigen::MatrixXd mine = information_(held, others);
  const auto others_information =
      Eigen::MatrixXd(information_(others, others)).completeOrthogonalDecomposition();
  const Eigen::VectorXd score =
      score_(held) - mine * others_information.solve(Eigen::VectorXd(score_(others)));
  const Eigen::MatrixXd information =
      information_(held, held) - mine * others_information.solve(mine.transpose());
  std::vector<HeldScore> scores(p_ - first_held);
  for (std::size_t k = 0; k < held.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (!(information(i, i) > kUnseen * information_(held[k], held[k]))) continue;
    scores[static_cast<std::size_t>(held[k]) - first_held] = {
        .z = -score[i] / std::sqrt(information(i, i)), .change = -score[i] / information(i, i)};
  }
  return scores;
}

FlockNoise Scoring::NoiseAt(const std::vector<double>& phi) const {
  return {.diffusion = 0.5 * std::exp(phi[p_]),
          .position_variance = phi[p_ + 1] > lowest_ ? std::exp(phi[p_ + 1]) - smallest_ : 0};
}
FilterSweep Scoring::SweepAt(const std::vector<double>& phi, FilterSweep memory) const {
  const std::vector<double> theta(phi.begin(), phi.begin() + static_cast<std::ptrdiff_t>(p_));
  if (paths_ == nullptr) {
    return RunFilter(options_.filter, model_, theta, NoiseAt(phi), input_, std::move(memory));
  }
  const std::span<const double> z = std::span(phi).subspan(own_);
  FilterSweep sweep = RunFilter(options_.filter, model_, theta, NoiseAt(phi),
                                paths_->Without(input_, z), std::move(memory));
  for (const double value : z) sweep.cost += value * value;
  sweep.cost -= 2 * paths_->LogVolume(z);
  return sweep;
}

void Scoring::Linearize(const FilterSweep& base) {
  const std::size_t count = base.innovations.size();
  roots_.resize(count);
  white_.resize(3 * static_cast<Eigen::Index>(count));
  for (std::size_t k = 0; k < count; ++k) {
    const Matrix3 s = CovarianceOf(base.innovations[k]);
    roots_[k] = Eigen::LLT<Matrix3>(s).matrixL().solve(Matrix3::Identity());
    white_.segment<3>(3 * static_cast<Eigen::Index>(k)) = roots_[k] * ValueOf(base.innovations[k]);
  }
  moved_.resize(own_);
  slopes_.resize(white_.size(), static_cast<Eigen::Index>(phi_.size()));
  changes_.resize(3 * white_.size(), static_cast<Eigen::Index>(own_));
  ParallelFor(options_.threads, 0, slopes_.cols(), 1, [&](std::int64_t first, std::int64_t last) {
    for (auto p = static_cast<std::size_t>(first); p < static_cast<std::size_t>(last); ++p) {
      std::vector<double> phi = phi_;
      phi[p] += differences_[p];
      FilterSweep moved = SweepAt(phi, p < own_ ? std::move(moved_[p]) : FilterSweep());
      const auto column = static_cast<Eigen::Index>(p);
      for (std::size_t k = 0; k < count; ++k) {
        const auto row = static_cast<Eigen::Index>(k);
        const Innovation &one = base.innovations[k], &other = moved.innovations[k];
        slopes_.col(column).segment<3>(3 * row) =
            roots_[k] * (ValueOf(other) - ValueOf(one)) / differences_[p];
        if (p >= own_) continue;
        Matrix3 change = roots_[k] * (CovarianceOf(other) - CovarianceOf(one)) *
                         roots_[k].transpose() / differences_[p];
        if (one.is_limited) change.setZero();
        changes_.col(column).segment<9>(9 * row) = Eigen::Map<const Vector9>(change.data());
      }
      if (p < own_) moved_[p] = std::move(moved);
    }
  });
  information_.noalias() = slopes_.transpose() * slopes_;
  score_.noalias() = slopes_.transpose() * white_;
  const auto size = static_cast<Eigen::Index>(own_);
  information_.topLeftCorner(size, size).noalias() += 0.5 * changes_.transpose() * changes_;
  for (std::size_t k = 0; k < count; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const Vector3 value = white_.segment<3>(3 * row);
    const Matrix3 surplus = Matrix3::Identity() - value * value.transpose();
    score_.head(size).noalias() += 0.5 * changes_.middleRows<9>(9 * row).transpose() *
                                   Eigen::Map<const Vector9>(surplus.data());
  }
  if (paths_ != nullptr) AddDepthErrors(base);
}

Eigen::VectorXd Scoring::Step() {
  const Eigen::Index size = score_.size();
  const bool at_zero = NoiseAt(phi_).position_variance <= 0;
  free_.assign(static_cast<std::size_t>(size), true);
  free_[p_] = !(phi_[p_] <= lowest_q_ && score_[static_cast<Eigen::Index>(p_)] >= 0);
  free_[p_ + 1] = !(at_zero && score_[static_cast<Eigen::Index>(p_) + 1] >= 0);
  const Eigen::VectorXd scale = information_.diagonal().cwiseSqrt();
  for (Eigen::Index p = 0; p < size; ++p) {
    if (!(scale[p] > 0)) free_[static_cast<std::size_t>(p)] = false;
  }
  const std::vector<Eigen::Index> used = Used();
  const auto n = static_cast<Eigen::Index>(used.size());
  Eigen::MatrixXd scaled(n, n);
  Eigen::VectorXd right(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      scaled(i, j) =
          information_(used[static_cast<std::size_t>(i)], used[static_cast<std::size_t>(j)]) /
          (scale[used[static_cast<std::size_t>(i)]] * scale[used[static_cast<std::size_t>(j)]]);
    }
    right[i] =
        -score_[used[static_cast<std::size_t>(i)]] / scale[used[static_cast<std::size_t>(i)]];
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  Eigen::VectorXd inverse = eigen.eigenvalues();
  for (double& value : inverse) value = value > kNothing ? 1 / value : 0;
  const Eigen::MatrixXd solution =
      eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
  covariance_ = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd step = Eigen::VectorXd::Zero(size);
  const Eigen::VectorXd scaled_step = solution * right;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index a = used[static_cast<std::size_t>(i)];
    step[a] = scaled_step[i] / scale[a];
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::Index b = used[static_cast<std::size_t>(j)];
      covariance_(a, b) = solution(i, j) / (scale[a] * scale[b]);
    }
  }
  for (Eigen::Index p = 0; p < size; ++p) {
    if (!(covariance_(p, p) > 0)) continue;
    differences_[static_cast<std::size_t>(p)] = kDifference * std::sqrt(covariance_(p, p));
  }
  return step;
}

std::vector<Eigen::Index> Scoring::Used() const {
  std::vector<Eigen::Index> used;
  for (std::size_t p = 0; p < free_.size(); ++p) {
    if (free_[p]) used.push_back(static_cast<Eigen::Index>(p));
  }
  return used;
}

double Scoring::Largest(const Eigen::VectorXd& step) const {
  double largest = 0;
  for (Eigen::Index p = 0; p < static_cast<Eigen::Index>(own_); ++p) {
    if (!(covariance_(p, p) > 0)) continue;
    largest = std::max(largest, std::abs(step[p]) / std::sqrt(covariance_(p, p)));
  }
  return largest;
}

bool Scoring::Walk(const Eigen::VectorXd& step, FilterSweep* sweep) {
  double share = 1;
  for (int halving = 0; halving < kHalvings; ++halving, share *= 0.5) {
    std::vector<double> phi = phi_;
    for (std::size_t p = 0; p < phi.size(); ++p) {
      const double limit = p < p_ ? std::numeric_limits<double>::infinity() : 3.0;
      phi[p] += std::clamp(share * step[static_cast<Eigen::Index>(p)], -limit, limit);
    }
    phi[p_] = std::max(phi[p_], lowest_q_);
    phi[p_ + 1] = std::max(phi[p_ + 1], lowest_);
    FilterSweep next = SweepAt(phi, std::move(spare_));
    double cost = CostBeside(*sweep, next);
    for (std::size_t p = 0; p < own_ && determinant_.size() > 0; ++p) {
      cost += 2 * determinant_[static_cast<Eigen::Index>(p)] * (phi[p] - phi_[p]);
    }
    spare_ = std::move(next);
    if (!(cost <= sweep->cost)) continue;
    phi_ = phi;
    std::swap(*sweep, spare_);
    return true;
  }
  return false;
}

void Scoring::Describe(const FilterSweep& sweep, StateSpaceFit* fit) const {
  fit->cost = sweep.cost;
  fit->noise = NoiseAt(phi_);
  fit->depth_errors.assign(phi_.begin() + static_cast<std::ptrdiff_t>(own_), phi_.end());
  fit->estimate.assign(phi_.begin(), phi_.begin() + static_cast<std::ptrdiff_t>(p_));
  const auto sd = [&](std::size_t p) {
    const double variance = covariance_(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(p));
    return variance > 0 ? std::sqrt(variance) : std::numeric_limits<double>::infinity();
  };
  for (std::size_t p = 0; p < p_; ++p) {
    fit->sd.push_back(sd(p));
    for (std::size_t r = 0; r < p_; ++r) {
      const double product = sd(p) * sd(r);
      const double shared = covariance_(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(r));
      fit->correlation.push_back(p == r ? 1 : std::isfinite(product) ? shared / product : 0);
    }
  }
  fit->diffusion_sd = free_[p_] ? fit->noise.diffusion * sd(p_) : 0;
  fit->position_variance_sd =
      free_[p_ + 1] ? (fit->noise.position_variance + smallest_) * sd(p_ + 1) : 0;
}

}  // namespace flocklift::internal
