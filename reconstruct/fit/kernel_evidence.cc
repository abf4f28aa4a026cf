// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/kernel_evidence.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kRounds = 200;
constexpr double kTolerance = 1e-3;  // of log variances and of the number of parameters
constexpr double kSmallest = 1e-24;  // share of y's mean square that counts as no noise at all
constexpr double kJitter = 1e-13;    // of a penalty's diagonal
constexpr double kLeast = 0.5;       // share of plain moments that correction leaves at least
constexpr double kLowerStep = 2;     // of log tau, when its least is sought
constexpr double kLowest = 30;       // beyond it
constexpr int kLowerHalvings = 4;
constexpr double kTauStep = 10;  // most that a tau changes in a round, as a factor

// Where a function is least: on a grid of whole numbers, then between the neighbours of the best.
template <typename Function>
double Least(const Function& cost, int first, int last) {
  double best = first, best_cost = HUGE_VAL;
  for (int at = first; at <= last; ++at) {
    const double here = cost(at);
    if (here < best_cost) {
      best_cost = here;
      best = at;
    }
  }
  double low = best - 1, high = best + 1;
  for (int step = 0; step < 40; ++step) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (cost(a) < cost(b)) {
      high = b;
    } else {
      low = a;
    }
  }
  return 0.5 * (low + high);
}

double LogDeterminant(const Eigen::LLT<MatrixXd>& factor) {
  const MatrixXd& half = factor.matrixLLT();
  return 2 * half.diagonal().array().log().sum();
}

// Values at `at` (increasing), at x on straight lines; beyond the last: that.
double Between(const std::vector<double>& at, const Eigen::RowVectorXd& values, double x) {
  const auto after = std::upper_bound(at.begin(), at.end(), x);
  if (after == at.end()) return values[values.size() - 1];
  const auto k = static_cast<Index>(after - at.begin());
  const double share = (x - *(after - 1)) / (*after - *(after - 1));
  return (1 - share) * values[k - 1] + share * values[k];
}

// Weighted normal equations.
struct System {
  MatrixXd a;  // symmetric
  VectorXd r;
};

class Solver {
 public:
  Solver(const KernelMoments& plain, const KernelMoments& corrected,
         const KernelPenalties& penalties, std::optional<double> position_variance)
      : plain_(plain),
        corrected_(corrected),
        penalties_(penalties),
        p_(plain.terms),
        known_s2_(position_variance),
        c_(VectorXd::Zero(plain.terms)) {
    double squares = 0;
    for (const auto& [place, bin] : plain.bins) {
      lambda_.push_back(bin.lambda / bin.rows);
      rows_.push_back(bin.rows);
      total_ += bin.rows;
      squares += bin.moment(p_, p_) / std::max(lambda_.back(), 1e-300);
    }
    middle_ = lambda_.empty() ? 1 : lambda_[lambda_.size() / 2];
    // To begin with, all of y is noise, half of it of either kind.
    smallest_ = kSmallest * squares / std::max(1.0, total_);
    s2_ = squares / std::max(1.0, total_) + 1e-300;
    d_ = s2_ * middle_;
    if (known_s2_) s2_ = *known_s2_;
  }

  KernelEvidence Run() {
    KernelEvidence result;
    VectorXd& c = c_;
    MatrixXd v = MatrixXd::Zero(p_, p_);
    double effective = 0;
    StartTaus();
    for (int round = 0; round < kRounds; ++round) {
      const System system = Weighted(corrected_, true), least_squares = Weighted(plain_, false);
      const MatrixXd s = Penalty();
      const Eigen::LLT<MatrixXd> factor(Positive(system.a + s, least_squares.a + s));
      c = factor.solve(system.r);
      v = factor.solve(MatrixXd::Identity(p_, p_));
      // Plain least squares leaves the least: the noise cannot run away with its corrections.
      const Eigen::LLT<MatrixXd> plain(least_squares.a + s);
      UpdateTaus(s, c, v);
      const double noise =
          UpdateNoise(plain.solve(least_squares.r), plain.solve(MatrixXd::Identity(p_, p_)));
      const double before = effective;
      effective = v.cwiseProduct(system.a).sum();
      if (round > 2 && noise < kTolerance &&
          std::abs(effective - before) < kTolerance * effective) {
        result.converged = true;
        break;
      }
    }
    const System plain = Weighted(plain_, false), system = Weighted(corrected_, true);
    const MatrixXd s = Penalty();
    const MatrixXd sum = Positive(system.a + s, plain.a + s);
    const Eigen::LLT<MatrixXd> factor(sum);
    result.coefficients = factor.solve(system.r);
    v = factor.solve(MatrixXd::Identity(p_, p_));
    result.effective = v.cwiseProduct(system.a).sum();
    result.h = sum;
    result.r = system.r;
    const MatrixXd data = sum - s;
    LowerTaus(data, system.r);
    v = Eigen::LLT<MatrixXd>(data + Penalty()).solve(MatrixXd::Identity(p_, p_));
    result.covariance = v;
    result.information = system.a.diagonal();
    if (&plain_ != &corrected_) {
      // What the features' errors add, where they add: the positive part of the difference.
      const Eigen::SelfAdjointEigenSolver<MatrixXd> extra(plain.a - system.a);
      const MatrixXd half =
          extra.eigenvectors() * extra.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
      const MatrixXd moved = v * half;
      result.covariance += moved * moved.transpose();
    }
    result.position_variance = s2_;
    result.diffusion = d_;
    Summarize(&result);
    return result;
  }

 private:
  double Variance(std::size_t bin) const { return s2_ * lambda_[bin] + d_; }

  // `a`, but no smaller than a share of `plain` in any direction: where position noise is nearly
  // all of the features, what is left after it is uncertain itself.
  static MatrixXd Positive(const MatrixXd& a, const MatrixXd& plain) {
    if (Eigen::LLT<MatrixXd>(a - kLeast * plain).info() == Eigen::Success) return a;
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(a, plain);
    const MatrixXd half = plain * eigen.eigenvectors();
    return half * eigen.eigenvalues().cwiseMax(kLeast).asDiagonal() * half.transpose();
  }

  // `felt`: without what the state has felt of the noise.
  System Weighted(const KernelMoments& moments, bool felt) const {
    MatrixXd sum = MatrixXd::Zero(p_ + 1, p_ + 1);
    std::size_t bin = 0;
    for (const auto& [place, gathered] : moments.bins) sum += gathered.moment / Variance(bin++);
    System system{sum.topLeftCorner(p_, p_).selfadjointView<Eigen::Lower>(),
                  sum.row(p_).head(p_).transpose()};
    if (!felt) return system;
    const VectorXd rates = moments.RatesOf(c_);
    for (const auto& [frames, divergence] : moments.divergence) {
      const KernelModes& modes = moments.modes.at(frames);
      const MatrixXd of_rate = d_ * (divergence * modes.Kappa(s2_, d_));  // terms x rates
      for (Index t = 0; t < p_; ++t) system.r[t] -= Between(modes.rates, of_rate.row(t), rates[t]);
    }
    return system;
  }

  MatrixXd Penalty() const {
    MatrixXd s = MatrixXd::Zero(p_, p_);
    for (std::size_t g = 0; g < penalties_.parts.size(); ++g) s += tau_[g] * penalties_.parts[g];
    return s;
  }

  // As much penalty as data.
  void StartTaus() {
    const double data = Weighted(plain_, false).a.trace();
    for (const MatrixXd& penalty : penalties_.parts) {
      tau_.push_back(std::max(1e-3 * data, 1e-300) / std::max(penalty.trace(), 1e-300));
    }
    start_ = tau_;
  }

  // S with its pins held, rows and columns scaled alike: smoothnesses differ by many orders of
  // magnitude.
  struct Held {
    VectorXd scale;
    Eigen::LLT<MatrixXd> factor;
  };
  Held Hold(MatrixXd s) const {
    for (const Index pin : penalties_.pins) s(pin, pin) *= 2;
    const VectorXd scale = s.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    MatrixXd scaled = scale.asDiagonal() * s * scale.asDiagonal();
    scaled.diagonal().array() += kJitter;
    return {scale, Eigen::LLT<MatrixXd>(scaled)};
  }

  // -2 log likelihood of tau with the noise as it is, but for what is the same for all tau.
  double SmoothnessCost(const MatrixXd& a, const VectorXd& r) const {
    const MatrixXd s = Penalty();
    const Eigen::LLT<MatrixXd> factor(a + s);
    const Held held = Hold(s);
    double pinned = 0;
    for (const Index pin : penalties_.pins) pinned += std::log(std::max(s(pin, pin), 1e-300));
    const double prior = LogDeterminant(held.factor) - 2 * held.scale.array().log().sum() - pinned;
    return LogDeterminant(factor) - r.dot(factor.solve(r)) - prior;
  }

  // Every tau as small as one standard error of the likelihood allows, the others as they are.
  void LowerTaus(const MatrixXd& a, const VectorXd& r) {
    const std::vector<double> best = tau_;
    std::vector<double> lowest = tau_;
    const double least = SmoothnessCost(a, r);
    for (std::size_t g = 0; g < best.size(); ++g) {
      const auto allows = [&](double log_factor) {
        tau_[g] = best[g] * std::exp(log_factor);
        return SmoothnessCost(a, r) < least + 1;
      };
      double low = 0, high = 0;
      do {
        high = low;
        low -= kLowerStep;
      } while (low > -kLowest && allows(low));
      for (int step = 0; step < kLowerHalvings; ++step) {
        const double middle = 0.5 * (low + high);
        (allows(middle) ? high : low) = middle;
      }
      lowest[g] = best[g] * std::exp(high);
      tau_[g] = best[g];
    }
    tau_ = lowest;
  }

  void UpdateTaus(const MatrixXd& s, const VectorXd& c, const MatrixXd& v) {
    const Held held = Hold(s);
    const MatrixXd inverse = held.scale.asDiagonal() *
                             held.factor.solve(MatrixXd::Identity(p_, p_)) *
                             held.scale.asDiagonal();
    for (std::size_t g = 0; g < penalties_.parts.size(); ++g) {
      const double prior = inverse.cwiseProduct(penalties_.parts[g]).sum();
      const double gained =
          std::max(prior - v.cwiseProduct(penalties_.parts[g]).sum(), 1e-9 * prior);
      const double rough = std::max(c.dot(penalties_.parts[g] * c), 1e-300);
      const double factor = std::clamp(gained / rough, 1 / kTauStep, kTauStep);
      // Beyond this a kernel is straight, or free.
      tau_[g] = std::clamp(tau_[g] * factor, 1e-12 * start_[g], 1e12 * start_[g]);
    }
  }

  // Sums of squares that the noise must answer for: residuals, and what the doubt of c adds.
  std::vector<double> Residuals(const VectorXd& c, const MatrixXd& v) const {
    std::vector<double> squares;
    for (const auto& [place, bin] : plain_.bins) {
      const auto m = bin.moment.topLeftCorner(p_, p_).template selfadjointView<Eigen::Lower>();
      const MatrixXd full = m;
      const double rss = bin.moment(p_, p_) - 2 * bin.moment.row(p_).head(p_).dot(c) +
                         c.dot(full * c) + v.cwiseProduct(full).sum();
      squares.push_back(std::max(rss, 0.0));
    }
    return squares;
  }

  // -2 log likelihood with s^2 as known.
  double KnownCost(const std::vector<double>& squares, double d) const {
    double sum = 0;
    for (std::size_t b = 0; b < squares.size(); ++b) {
      const double v = *known_s2_ * lambda_[b] + d;
      sum += squares[b] / v + rows_[b] * std::log(v);
    }
    return sum;
  }

  // -2 log likelihood with s^2 = ratio * scale, D = (1 - ratio) * scale * middle lambda, the best
  // scale put in.
  double Cost(const std::vector<double>& squares, double ratio, double* scale) const {
    double sum = 0, logs = 0;
    for (std::size_t b = 0; b < squares.size(); ++b) {
      const double shape = ratio * lambda_[b] + (1 - ratio) * middle_;
      sum += squares[b] / shape;
      logs += rows_[b] * std::log(shape);
    }
    *scale = std::max(sum / total_, smallest_);
    return total_ * std::log(*scale) + logs;
  }

  double UpdateNoise(const VectorXd& c, const MatrixXd& v) {
    const std::vector<double> squares = Residuals(c, v);
    const double before = std::log(Variance(0)) + std::log(Variance(lambda_.size() - 1));
    if (known_s2_) {
      double all = 0;  // as if there were nothing else
      for (std::size_t b = 0; b < squares.size(); ++b) {
        all += squares[b] / std::max(lambda_[b], 1e-300);
      }
      const double most = std::max(all / total_, *known_s2_) * lambda_.back() + 1e-300;
      const auto d = [&](double log_share) { return most * std::exp(log_share); };
      d_ = d(Least([&](double at) { return KnownCost(squares, d(at)); }, -60, 5));
    } else {
      double scale = 0;
      const auto ratio = [](double logit) { return 1 / (1 + std::exp(-logit)); };
      const double at =
          ratio(Least([&](double logit) { return Cost(squares, ratio(logit), &scale); }, -30, 30));
      Cost(squares, at, &scale);
      s2_ = at * scale;
      d_ = (1 - at) * scale * middle_;
    }
    const double after = std::log(Variance(0)) + std::log(Variance(lambda_.size() - 1));
    return std::abs(after - before);
  }

  void Summarize(KernelEvidence* result) const {
    const VectorXd& c = result->coefficients;
    const std::vector<double> squares = Residuals(c, MatrixXd::Zero(p_, p_));
    double residual = 0, all = 0;
    std::size_t b = 0;
    for (const auto& [place, bin] : plain_.bins) {
      residual += squares[b] / Variance(b);
      all += bin.moment(p_, p_) / Variance(b++);
    }
    result->explained = 1 - residual / std::max(all, 1e-300);
  }

  const KernelMoments& plain_;
  const KernelMoments& corrected_;
  const KernelPenalties& penalties_;
  Index p_;
  std::optional<double> known_s2_;
  std::vector<double> lambda_, rows_;  // by bin
  double total_ = 0, middle_ = 1, smallest_ = 0;
  double s2_ = 1, d_ = 1;
  VectorXd c_;
  std::vector<double> tau_, start_;
};

}  // namespace

KernelEvidence SolveKernels(const KernelMoments& plain, const KernelMoments& corrected,
                            const KernelPenalties& penalties,
                            std::optional<double> position_variance) {
  Check(plain.terms > 0 && !plain.bins.empty(), "no equations");
  Check(plain.bins.size() == corrected.bins.size(), "moments of different runs");
  return Solver(plain, corrected, penalties, position_variance).Run();
}

}  // namespace flocklift
