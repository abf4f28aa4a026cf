// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/fit_measures.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace flocklift {
namespace {

// Of the weights of `terms` times their scales.
Eigen::MatrixXd CovarianceOf(const RegressionResult& regression, const std::vector<double>& scale,
                             const std::vector<std::size_t>& terms) {
  const std::size_t p = regression.sd.size();
  const auto n = static_cast<Eigen::Index>(terms.size());
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const std::size_t a = terms[static_cast<std::size_t>(i)];
      const std::size_t b = terms[static_cast<std::size_t>(j)];
      covariance(i, j) = regression.correlation[a * p + b] * regression.sd[a] * regression.sd[b] *
                         scale[a] * scale[b];
    }
  }
  return covariance;
}

struct ScaledCovariance {
  std::vector<std::size_t> terms;  // those of finite sd
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
};

ScaledCovariance Decompose(const RegressionResult& regression, const std::vector<double>& rms) {
  ScaledCovariance result;
  for (std::size_t c = 0; c < rms.size(); ++c) {
    if (std::isfinite(regression.sd[c])) result.terms.push_back(c);
  }
  const auto n = static_cast<Eigen::Index>(result.terms.size());
  const Eigen::MatrixXd covariance = CovarianceOf(regression, rms, result.terms);
  if (n > 0) result.eigen.compute(covariance);
  return result;
}

FitDirection DirectionOf(const ScaledCovariance& scaled, std::size_t terms, bool worst) {
  FitDirection direction{.weights = std::vector<double>(terms, 0.0), .sd = 0};
  if (scaled.terms.empty()) return direction;
  const Eigen::Index column = worst ? static_cast<Eigen::Index>(scaled.terms.size()) - 1 : 0;
  Eigen::VectorXd vector = scaled.eigen.eigenvectors().col(column);
  Eigen::Index largest = 0;
  vector.cwiseAbs().maxCoeff(&largest);
  if (vector[largest] < 0) vector = -vector;
  for (std::size_t k = 0; k < scaled.terms.size(); ++k) {
    direction.weights[scaled.terms[k]] = vector[static_cast<Eigen::Index>(k)];
  }
  direction.sd = std::sqrt(std::max(0.0, scaled.eigen.eigenvalues()[column]));
  return direction;
}

// Sums over rows of y . yhat, |yhat|^2 and |y|^2.
struct PredictionSums {
  double product = 0, predicted = 0, observed = 0;
};

PredictionSums SumPredictions(const MotionRows& rows, const std::vector<double>& theta,
                              const std::vector<double>& own) {
  PredictionSums sums;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double factor = own[static_cast<std::size_t>(rows.animal[k])];
    if (std::isnan(factor)) continue;
    const std::size_t at = k * (rows.terms + 1);
    Vec3d prediction = rows.near_known[k] + factor * rows.near[at + rows.terms];
    for (std::size_t c = 0; c < rows.terms; ++c) prediction += theta[c] * rows.near[at + c];
    sums.product += Dot(rows.response[k], prediction);
    sums.predicted += SquaredNorm(prediction);
    sums.observed += SquaredNorm(rows.response[k]);
  }
  return sums;
}

}  // namespace

double MeanSquare(const std::vector<Vec3d>& values) {
  double sum = 0;
  for (const Vec3d& v : values) sum += SquaredNorm(v);
  return values.empty() ? 0 : sum / (3.0 * static_cast<double>(values.size()));
}

std::vector<double> OwnFactors(const MotionRows& rows, const std::vector<double>& theta,
                               int animals) {
  const auto n = static_cast<std::size_t>(animals);
  const std::vector<Vec3d> u = Unexplained(rows, theta, false);
  std::vector<double> products(n), squares(n), factors(n);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::size_t at = k * (rows.terms + 1) + rows.terms;
    const auto animal = static_cast<std::size_t>(rows.animal[k]);
    products[animal] += Dot(rows.near[at], u[k]);
    squares[animal] += Dot(rows.near[at], rows.features[at]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    factors[i] =
        squares[i] > 0 ? products[i] / squares[i] : std::numeric_limits<double>::quiet_NaN();
  }
  return factors;
}

std::optional<double> HeldOutR2(const WhiteningOptions& whitening, const MotionRows& rows,
                                int split, int animals) {
  const MotionRows train = rows.Before(split);
  const MotionRows test = rows.From(split);
  if (test.size() < 10) return std::nullopt;
  const WhitenedFit fit = SolveWhitened(whitening, train);
  if (!fit.IsUsable()) return std::nullopt;
  const std::vector<double>& theta = fit.regression.estimate;
  std::vector<double> own(static_cast<std::size_t>(animals), 0.0);
  if (whitening.own_speed) own = OwnFactors(train, theta, animals);
  const PredictionSums before = SumPredictions(train, theta, own);
  const PredictionSums after = SumPredictions(test, theta, own);
  if (before.predicted == 0 || after.observed == 0) return std::nullopt;
  const double b = before.product / before.predicted;
  return (2 * b * after.product - b * b * after.predicted) / after.observed;
}

double PullToTheMiddle(const MotionRows& rows, const std::vector<Vec3d>& u) {
  Vec3d mean;
  for (const Vec3d& x : rows.position) mean += x;
  mean = mean / static_cast<double>(std::max<std::size_t>(rows.size(), 1));
  double product = 0, squares_x = 0, squares_u = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Vec3d inwards = mean - rows.position[k];
    product += Dot(inwards, u[k]);
    squares_x += SquaredNorm(inwards);
    squares_u += SquaredNorm(u[k]);
  }
  if (product <= 0 || squares_x == 0 || squares_u == 0) return 0;
  return product * product / (squares_x * squares_u);
}

NoiseEstimate EstimateNoise(const MotionRows& rows, const std::vector<Vec3d>& u,
                            const std::optional<double>& rho, double dt, double engine_step) {
  NoiseEstimate noise;
  const double width = rows.window * dt;
  if (rho && *rho > 0) {
    const int lag = 2 * rows.window + 3;
    noise.time = -width / std::log(*rho);
    const double covariance = CorrelationAtLag(rows, u, lag).covariance;
    noise.sd = std::sqrt(std::max(0.0, covariance) * std::exp(lag * dt / noise.time));
    return noise;
  }
  const double here = MeanSquare(u), there = CorrelationAtLag(rows, u, rows.window).covariance;
  const double variance = std::max(0.0, (4 * here + 6 * there) / 5.5);
  noise.diffusion = 0.75 * width * variance;
  noise.sd = std::sqrt(2 * noise.diffusion / engine_step);
  return noise;
}

double RoundingOf(double value) {
  return 4 * std::numeric_limits<float>::epsilon() * std::abs(value);
}

std::vector<double> ChangedShares(const MotionRows& rows, const MotionRows& other) {
  const std::size_t width = rows.terms + 1;
  std::vector<double> changes(rows.terms), squares(rows.terms), shares(rows.terms);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::int64_t found = other.Find(rows.frame[k], rows.animal[k]);
    if (found < 0) continue;
    for (std::size_t c = 0; c < rows.terms; ++c) {
      const Vec3d& here = rows.features[k * width + c];
      changes[c] += SquaredNorm(other.features[static_cast<std::size_t>(found) * width + c] - here);
      squares[c] += SquaredNorm(here);
    }
  }
  for (std::size_t c = 0; c < rows.terms; ++c) {
    shares[c] = squares[c] > 0 ? changes[c] / squares[c] : 0;
  }
  return shares;
}

std::vector<double> ProbableWeights(const RegressionResult& regression,
                                    const std::vector<double>& rms, double acceleration_rms,
                                    const std::vector<bool>& positive) {
  std::vector<double> weights = regression.estimate;
  std::vector<std::size_t> terms;
  for (std::size_t c = 0; c < weights.size(); ++c) {
    if (std::isfinite(regression.sd[c])) terms.push_back(c);
  }
  if (terms.empty() || acceleration_rms <= 0) return weights;
  // In units of the prior's sd: prior I, likelihood N(t, V), so mean t - V (I + V)^-1 t.
  std::vector<double> scale(weights.size());
  for (const std::size_t c : terms) scale[c] = rms[c] / acceleration_rms;
  const Eigen::MatrixXd v = CovarianceOf(regression, scale, terms);
  const auto n = static_cast<Eigen::Index>(terms.size());
  Eigen::VectorXd t(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const std::size_t c = terms[static_cast<std::size_t>(k)];
    t[k] = regression.estimate[c] * scale[c];
  }
  const Eigen::LDLT<Eigen::MatrixXd> sum(v + Eigen::MatrixXd::Identity(n, n));
  const Eigen::VectorXd mean = t - v * sum.solve(t);
  const Eigen::MatrixXd covariance = v - v * sum.solve(v);
  // Negative ones are held at 0, one after the other, and the rest is conditioned on it.
  std::vector<Eigen::Index> held;
  Eigen::VectorXd mode = mean;
  for (;;) {
    Eigen::Index lowest = -1;
    for (Eigen::Index k = 0; k < n; ++k) {
      if (!positive[terms[static_cast<std::size_t>(k)]] || mode[k] >= 0) continue;
      if (std::find(held.begin(), held.end(), k) != held.end()) continue;
      if (lowest < 0 || mode[k] < mode[lowest]) lowest = k;
    }
    if (lowest < 0) break;
    held.push_back(lowest);
    const Eigen::MatrixXd of_held = covariance(held, held);
    const Eigen::VectorXd at_held = mean(held);
    mode = mean -
           covariance(Eigen::all, held) * of_held.completeOrthogonalDecomposition().solve(at_held);
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    const std::size_t c = terms[static_cast<std::size_t>(k)];
    const bool at_zero = std::find(held.begin(), held.end(), k) != held.end();
    weights[c] = at_zero ? 0 : mode[k] / scale[c];
  }
  return weights;
}

FitDirection BestDirection(const RegressionResult& regression, const std::vector<double>& rms) {
  return DirectionOf(Decompose(regression, rms), rms.size(), false);
}

FitDirection WorstDirection(const RegressionResult& regression, const std::vector<double>& rms) {
  return DirectionOf(Decompose(regression, rms), rms.size(), true);
}

}  // namespace flocklift
