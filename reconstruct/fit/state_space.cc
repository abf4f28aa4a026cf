// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/state_space.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "simulate/core/check.h"
#include "simulate/core/parallel_for.h"

namespace flocklift {
namespace {

using Matrix3 = Eigen::Matrix3d;
using Vector3 = Eigen::Vector3d;

constexpr double kFirstDifference = 1e-6;  // of an unknown, before its sd is known
constexpr double kDifference = 0.01;       // ... of its sd, afterwards
constexpr double kSmallVariance = 1e-3;    // s0^2, of how far the noise moves in a frame
constexpr double kNothing = 1e-12;         // an information below this share of the others'
constexpr double kUnseen = 1e-6;           // ... of a parameter's own, beside the others
constexpr int kHalvings = 12;

Vector3 ValueOf(const Innovation& i) { return {i.value[0], i.value[1], i.value[2]}; }
Matrix3 CovarianceOf(const Innovation& i) {
  const auto& c = i.covariance;
  Matrix3 s;
  s << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
  return s;
}

double CostOf(const Vector3& value, const Matrix3& covariance) {
  const Eigen::LLT<Matrix3> llt(covariance);
  const Vector3 white = llt.matrixL().solve(value);
  return 2 * std::log(llt.matrixL().toDenseMatrix().diagonal().prod()) + white.squaredNorm();
}

// phi = (theta, log q, log(s^2 + s0^2)).
class Scoring {
 public:
  Scoring(const StateSpaceOptions& options, const ProcessModel& model,
          const std::vector<double>& start, const FilterInput& input)
      : options_(options), model_(model), input_(input), p_(start.size()) {
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
  }

  StateSpaceFit Run() {
    StateSpaceFit fit;
    FilterSweep sweep = SweepAt(phi_);
    fit.innovations = sweep.innovations.size();
    if (3 * sweep.innovations.size() < 10 * phi_.size() || !std::isfinite(sweep.cost)) {
      fit.status = StateSpaceStatus::kTooFew;
      return fit;
    }
    fit.status = StateSpaceStatus::kNotConverged;
    for (fit.rounds = 1; fit.rounds <= options_.rounds; ++fit.rounds) {
      Linearize(sweep);
      const Eigen::VectorXd step = Step();
      const bool small = Largest(step) < options_.accuracy;
      if (!Walk(step, &sweep) || small) {
        fit.status =
            small || Largest(step) < 0.3 ? StateSpaceStatus::kOk : StateSpaceStatus::kNotConverged;
        break;
      }
    }
    Describe(sweep, &fit);
    return fit;
  }

  // At `start` and this noise: of the parameters from `first_held` on.
  std::vector<HeldScore> Score(const FlockNoise& noise, std::size_t first_held) {
    phi_[p_] = std::log(2 * noise.diffusion);
    phi_[p_ + 1] = std::max(lowest_, std::log(noise.position_variance + smallest_));
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

 private:
  FlockNoise NoiseAt(const std::vector<double>& phi) const {
    return {.diffusion = 0.5 * std::exp(phi[p_]),
            .position_variance = phi[p_ + 1] > lowest_ ? std::exp(phi[p_ + 1]) - smallest_ : 0};
  }
  FilterSweep SweepAt(const std::vector<double>& phi) const {
    const std::vector<double> theta(phi.begin(), phi.begin() + static_cast<std::ptrdiff_t>(p_));
    return RunFilter(options_.filter, model_, theta, NoiseAt(phi), input_);
  }

  // Score and information at phi_.
  void Linearize(const FilterSweep& base) {
    const std::size_t m = phi_.size();
    std::vector<FilterSweep> moved(m);
    ParallelFor(options_.threads, 0, static_cast<std::int64_t>(m), 1,
                [&](std::int64_t first, std::int64_t last) {
                  for (auto p = static_cast<std::size_t>(first); p < static_cast<std::size_t>(last);
                       ++p) {
                    std::vector<double> phi = phi_;
                    phi[p] += differences_[p];
                    moved[p] = SweepAt(phi);
                  }
                });
    const auto size = static_cast<Eigen::Index>(m);
    score_ = Eigen::VectorXd::Zero(size);
    information_ = Eigen::MatrixXd::Zero(size, size);
    Eigen::Matrix<double, 12, Eigen::Dynamic> rows(12, size);  // whitened eps_p, then S_p
    Eigen::Matrix<double, 12, 1> response;
    for (std::size_t k = 0; k < base.innovations.size(); ++k) {
      const Vector3 value = ValueOf(base.innovations[k]);
      const Matrix3 s = CovarianceOf(base.innovations[k]);
      const Matrix3 root = Eigen::LLT<Matrix3>(s).matrixL().solve(Matrix3::Identity());
      const Vector3 white = root * value;
      const Matrix3 surplus = Matrix3::Identity() - white * white.transpose();
      response << white, Eigen::Map<const Eigen::Matrix<double, 9, 1>>(surplus.data());
      for (Eigen::Index p = 0; p < size; ++p) {
        const auto at = static_cast<std::size_t>(p);
        const Innovation& other = moved[at].innovations[k];
        const Vector3 slope = root * (ValueOf(other) - value) / differences_[at];
        Matrix3 change = root * (CovarianceOf(other) - s) * root.transpose() / differences_[at];
        if (base.innovations[k].is_limited) change.setZero();
        rows.col(p) << slope,
            std::sqrt(0.5) * Eigen::Map<const Eigen::Matrix<double, 9, 1>>(change.data());
      }
      information_.noalias() += rows.transpose() * rows;
      response.tail<9>() *= std::sqrt(0.5);
      score_.noalias() += rows.transpose() * response;
    }
  }

  // -I^-1 g over what the data speak of; s^2 at 0 that wants to fall further has no part.
  Eigen::VectorXd Step() {
    const Eigen::Index size = score_.size();
    const auto last = static_cast<std::size_t>(size) - 1;
    const bool at_zero = NoiseAt(phi_).position_variance <= 0;
    free_.assign(static_cast<std::size_t>(size), true);
    free_[last] = !(at_zero && score_[size - 1] >= 0);
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

  std::vector<Eigen::Index> Used() const {
    std::vector<Eigen::Index> used;
    for (std::size_t p = 0; p < free_.size(); ++p) {
      if (free_[p]) used.push_back(static_cast<Eigen::Index>(p));
    }
    return used;
  }

  // In units of the sd.
  double Largest(const Eigen::VectorXd& step) const {
    double largest = 0;
    for (Eigen::Index p = 0; p < step.size(); ++p) {
      if (!(covariance_(p, p) > 0)) continue;
      largest = std::max(largest, std::abs(step[p]) / std::sqrt(covariance_(p, p)));
    }
    return largest;
  }

  // Along the step, halved until the cost falls; false when it never does.
  bool Walk(const Eigen::VectorXd& step, FilterSweep* sweep) {
    double share = 1;
    for (int halving = 0; halving < kHalvings; ++halving, share *= 0.5) {
      std::vector<double> phi = phi_;
      for (std::size_t p = 0; p < phi.size(); ++p) {
        const double limit = p < p_ ? std::numeric_limits<double>::infinity() : 3.0;
        phi[p] += std::clamp(share * step[static_cast<Eigen::Index>(p)], -limit, limit);
      }
      phi.back() = std::max(phi.back(), lowest_);
      FilterSweep next = SweepAt(phi);
      if (!(CostBeside(*sweep, next) <= sweep->cost)) continue;
      phi_ = phi;
      *sweep = std::move(next);
      return true;
    }
    return false;
  }

  // -2 log likelihood of the next sweep, with this one's covariances where a limit acted: what the
  // scoring descends.
  static double CostBeside(const FilterSweep& sweep, const FilterSweep& next) {
    double cost = next.cost;
    for (std::size_t k = 0; k < sweep.innovations.size(); ++k) {
      if (!sweep.innovations[k].is_limited) continue;
      const Vector3 value = ValueOf(next.innovations[k]);
      cost += CostOf(value, CovarianceOf(sweep.innovations[k])) -
              CostOf(value, CovarianceOf(next.innovations[k]));
    }
    return cost;
  }

  void Describe(const FilterSweep& sweep, StateSpaceFit* fit) const {
    fit->cost = sweep.cost;
    fit->noise = NoiseAt(phi_);
    fit->estimate.assign(phi_.begin(), phi_.begin() + static_cast<std::ptrdiff_t>(p_));
    const auto sd = [&](std::size_t p) {
      const double variance =
          covariance_(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(p));
      return variance > 0 ? std::sqrt(variance) : std::numeric_limits<double>::infinity();
    };
    for (std::size_t p = 0; p < p_; ++p) {
      fit->sd.push_back(sd(p));
      for (std::size_t r = 0; r < p_; ++r) {
        const double product = sd(p) * sd(r);
        const double shared =
            covariance_(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(r));
        fit->correlation.push_back(p == r ? 1 : std::isfinite(product) ? shared / product : 0);
      }
    }
    fit->diffusion_sd = fit->noise.diffusion * sd(p_);
    fit->position_variance_sd =
        free_[p_ + 1] ? (fit->noise.position_variance + smallest_) * sd(p_ + 1) : 0;
  }

  const StateSpaceOptions& options_;
  const ProcessModel& model_;
  const FilterInput& input_;
  std::size_t p_;
  std::vector<double> phi_, differences_;
  double smallest_ = 0, lowest_ = 0;  // s0^2 and its logarithm
  std::vector<bool> free_;
  Eigen::VectorXd score_;
  Eigen::MatrixXd information_, covariance_;
};

}  // namespace

StateSpaceFit FitStateSpace(const StateSpaceOptions& options, const ProcessModel& model,
                            const std::vector<double>& start, const FilterInput& input) {
  Check(start.size() == model.free.size(), "a start needs one value a parameter");
  Check(options.rounds > 0 && options.accuracy > 0, "scoring needs rounds and an accuracy");
  const auto& moments = input.second_differences();
  if (!(moments[0] > 0) || !std::isfinite(moments[1])) {
    StateSpaceFit none;
    none.status = StateSpaceStatus::kTooFew;
    return none;
  }
  return Scoring(options, model, start, input).Run();
}

std::vector<HeldScore> ScoreHeld(const StateSpaceOptions& options, const ProcessModel& model,
                                 const StateSpaceFit& fit, std::span<const double> held,
                                 const FilterInput& input) {
  Check(fit.IsUsable() && model.free.size() == fit.estimate.size() + held.size(),
        "a score is of the parameters after those of a fit");
  std::vector<double> theta = fit.estimate;
  theta.insert(theta.end(), held.begin(), held.end());
  return Scoring(options, model, theta, input).Score(fit.noise, fit.estimate.size());
}

}  // namespace flocklift
