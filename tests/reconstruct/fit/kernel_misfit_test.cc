// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/kernel_misfit.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kReach = 2;
constexpr int kPairs = 1600;  // evenly in [0, kReach], each an equation for phi where it is

SplineBasis Even(int intervals) {
  std::vector<double> breaks;
  for (int k = 0; k <= intervals; ++k) breaks.push_back(kReach * k / intervals);
  return SplineBasis(breaks, 3);
}

PairDensity EvenPairs() {
  return {.low = 0, .high = kReach, .share = std::vector<double>(64, 1.0 / 64), .pairs = kPairs};
}

double Distance(int pair) { return kReach * (pair + 0.5) / kPairs; }

// Equations phi(r) = y(r) +- sd.
struct Equations {
  MatrixXd h;
  VectorXd r;

  VectorXd Solution() const { return Eigen::LLT<MatrixXd>(h).solve(r); }
};

Equations Seen(const SplineBasis& basis, const std::function<double(double)>& y, double sd) {
  Equations equations{MatrixXd::Zero(basis.size(), basis.size()), VectorXd::Zero(basis.size())};
  for (int pair = 0; pair < kPairs; ++pair) {
    VectorXd row = VectorXd::Zero(basis.size());
    const SplineBasis::Local local = basis.At(Distance(pair));
    for (int i = 0; i <= basis.degree(); ++i) {
      row[local.first + i] = local.value[static_cast<std::size_t>(i)];
    }
    equations.h += row * row.transpose() / (sd * sd);
    equations.r += row * y(Distance(pair)) / (sd * sd);
  }
  return equations;
}

std::vector<double> Misfit(const SplineBasis& basis, const Equations& equations) {
  return KernelMisfits({basis}, EvenPairs(), equations.h, equations.r)[0];
}

// rms between each two of the even breaks.
std::vector<double> Errors(const SplineBasis& basis, const VectorXd& c,
                           const std::function<double(double)>& truth) {
  const int intervals = basis.size() - basis.degree(), each = kPairs / intervals;
  const std::vector<double> of_basis(c.begin(), c.end());
  std::vector<double> errors;
  for (int k = 0; k < intervals; ++k) {
    double squares = 0;
    for (int pair = each * k; pair < each * (k + 1); ++pair) {
      const double r = Distance(pair);
      squares += std::pow(basis.Value(of_basis, r) - truth(r), 2);
    }
    errors.push_back(std::sqrt(squares / each));
  }
  return errors;
}

double Rms(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

constexpr double kExact = 1e-6;  // sd of equations whose noise does not matter

TEST(KernelMisfit, IsNoneWhereTheCoarsestSplineFollows) {
  const SplineBasis coarsest = Even(4);
  const std::vector<double> c = {0.3, -0.2, 0.5, 0.1, 0.4, -0.3, 0.2};
  const SplineBasis basis = Even(16);
  const Equations equations = Seen(
      basis, [&](double r) { return coarsest.Value(c, r); }, kExact);
  for (const double misfit : Misfit(basis, equations)) EXPECT_LT(misfit, 1e-7);
}

// By where the kink is between the coarsest breaks from half the error to five times it, twice over
// all places; and half as wide next to it where intervals are halved.
TEST(KernelMisfit, OfAKinkIsNearTheErrorAndHalvesWithTheIntervals) {
  constexpr int kPlaces = 15;  // even over an interval of the coarsest spline, here and halved
  double last_misfit = 0, last_error = 0;
  for (const int intervals : {16, 32, 64}) {
    const SplineBasis basis = Even(intervals);
    double misfit = 0, error = 0, misfit_squares = 0, error_squares = 0;
    for (int place = 0; place < kPlaces; ++place) {
      const double at = 0.75 + 0.5 * (place + 0.5) / kPlaces;
      const auto kink = [at](double r) { return std::abs(r - at); };
      const Equations equations = Seen(basis, kink, kExact);
      const std::vector<double> misfits = Misfit(basis, equations);
      const std::vector<double> errors = Errors(basis, equations.Solution(), kink);
      EXPECT_GT(Rms(misfits), 0.5 * Rms(errors)) << intervals << " " << at;
      EXPECT_LT(Rms(misfits), 5 * Rms(errors)) << intervals << " " << at;
      misfit_squares += std::pow(Rms(misfits), 2);
      error_squares += std::pow(Rms(errors), 2);
      misfit += *std::max_element(misfits.begin(), misfits.end());
      error += *std::max_element(errors.begin(), errors.end());
    }
    EXPECT_NEAR(std::sqrt(misfit_squares / error_squares), 2, 0.5) << intervals;
    if (last_misfit > 0) {
      EXPECT_NEAR(error / last_error, 0.5, 0.01) << intervals;
      EXPECT_NEAR(misfit / last_misfit, 0.5, 0.05) << intervals;
    }
    last_misfit = misfit;
    last_error = error;
  }
}

// The band: noise makes the variance of the values kNoise^2 / kPairs for each function.
TEST(KernelMisfit, OfNoiseAloneIsSmallBesideTheBand) {
  constexpr int kDraws = 20;
  constexpr double kNoise = 0.1;
  const SplineBasis basis = Even(16);
  const auto line = [](double r) { return 0.3 - 0.1 * r; };
  const double band = kNoise * kNoise * basis.size() / kPairs;
  double misfit = 0, error = 0;
  for (std::uint64_t draw = 1; draw <= kDraws; ++draw) {
    Rng rng(draw, 3);
    const Equations equations = Seen(
        basis, [&](double r) { return line(r) + kNoise * rng.Normal(); }, kNoise);
    misfit += std::pow(Rms(Misfit(basis, equations)), 2) / kDraws;
    error += std::pow(Rms(Errors(basis, equations.Solution(), line)), 2) / kDraws;
  }
  EXPECT_NEAR(error, band, 0.15 * band);
  EXPECT_LT(misfit, 0.2 * band);
}

// The kernels' equations have nothing to do with each other: nor have their misfits.
TEST(KernelMisfit, IsOfEachKernelByItself) {
  const SplineBasis fine = Even(32), coarse = Even(16);
  const Equations kink = Seen(
      fine, [](double r) { return std::abs(r - 1.03); }, kExact);
  const Equations line = Seen(
      coarse, [](double r) { return 0.3 - 0.1 * r; }, kExact);
  const Index n = fine.size(), p = n + coarse.size();
  MatrixXd h = MatrixXd::Zero(p, p);
  h.topLeftCorner(n, n) = kink.h;
  h.bottomRightCorner(p - n, p - n) = line.h;
  VectorXd r(p);
  r << kink.r, line.r;
  const std::vector<std::vector<double>> both = KernelMisfits({fine, coarse}, EvenPairs(), h, r);
  const std::vector<double> alone = Misfit(fine, kink);
  ASSERT_EQ(both.size(), 2U);
  ASSERT_EQ(both[0].size(), 32U);
  ASSERT_EQ(both[1].size(), 16U);
  for (std::size_t k = 0; k < alone.size(); ++k) EXPECT_NEAR(both[0][k], alone[k], 1e-7);
  for (const double misfit : both[1]) EXPECT_LT(misfit, 1e-7);
}

}  // namespace
}  // namespace flocklift
