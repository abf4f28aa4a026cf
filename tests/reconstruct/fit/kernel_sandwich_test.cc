// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/kernel_sandwich.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "reconstruct/fit/kernel_penalties.h"
#include "simulate/core/rng.h"
#include "tests/reconstruct/fit/kernel_flock.h"

namespace flocklift {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double Curved(double r) { return 0.4 * std::exp(-r); }

// In the plane.
KernelDesign Design(int order, std::vector<double> breaks, int degree) {
  KernelDesign design;
  design.order = order;
  design.attraction = design.alignment = SplineBasis(std::move(breaks), degree);
  design.has_alignment = order == 2;
  design.coordinates = {true, true, false};
  return design;
}

KernelFlock Small(int order) {
  return {.order = order,
          .animals = 4,
          .dimensions = 2,
          .frames = 16,
          .substeps = 4,
          .attraction = Curved,
          .alignment = {}};
}

// Flight by flight another flock: `of_flight` changes it.
std::vector<ObservedFlock> Flights(
    const KernelFlock& flock, int flights, std::uint64_t seed,
    const std::function<void(Rng*, KernelFlock*)>& of_flight = nullptr) {
  std::vector<ObservedFlock> observed;
  for (int flight = 0; flight < flights; ++flight) {
    const std::uint64_t of_its_own = 1000 * seed + static_cast<std::uint64_t>(flight);
    KernelFlock flown = flock;
    Rng rng(of_its_own, 5);
    if (of_flight) of_flight(&rng, &flown);
    observed.emplace_back(FlyKernels(flown, of_its_own), 1 / flock.dt, 0);
  }
  return observed;
}

struct Solved {
  KernelMoments moments;
  KernelEvidence evidence;
};

Solved Solve(const KernelDesign& design, const std::vector<ObservedFlock>& flocks) {
  Solved solved{GatherKernelMoments(design, flocks, flocks, 1), {}};
  solved.evidence = SolveKernels(solved.moments, solved.moments, SmoothnessOf(design));
  return solved;
}

MatrixXd Sandwich(const KernelDesign& design, const std::vector<ObservedFlock>& flocks,
                  const Solved& solved, int threads = 1) {
  return KernelSandwich(design, flocks, solved.moments.modes, solved.evidence, threads);
}

// sum_f (g_f - g)(g_f - g)' n / (n - 1) of white rows of variance D, from each flight's moments.
MatrixXd Meat(const KernelDesign& design, const std::vector<ObservedFlock>& flocks,
              const KernelEvidence& evidence) {
  const Index p = design.terms();
  const auto n = static_cast<Index>(flocks.size());
  MatrixXd scores = MatrixXd::Zero(p, n);
  for (Index f = 0; f < n; ++f) {
    const std::vector<ObservedFlock> one = {flocks[static_cast<std::size_t>(f)]};
    const KernelMoments moments = GatherKernelMoments(design, one, one, 1);
    for (const auto& [place, bin] : moments.bins) {
      const MatrixXd full = bin.moment.selfadjointView<Eigen::Lower>();
      scores.col(f) += (full.col(p).head(p) - full.topLeftCorner(p, p) * evidence.coefficients) /
                       evidence.diffusion;
    }
  }
  const VectorXd mean = scores.rowwise().mean();
  const MatrixXd about = scores.colwise() - mean;
  return about * about.transpose() * (static_cast<double>(n) / static_cast<double>(n - 1));
}

// Eigenvalues of V^-1 V': how much wider in which direction, increasing.
VectorXd Widened(const MatrixXd& v, const MatrixXd& wider) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(wider, v, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

// Variance of the kernel's value at a distance.
double VarianceAt(const SplineBasis& basis, const MatrixXd& covariance, double r) {
  VectorXd values = VectorXd::Zero(covariance.rows());
  const SplineBasis::Local local = basis.At(r);
  for (int i = 0; i <= basis.degree(); ++i) {
    values[local.first + i] = local.value[static_cast<std::size_t>(i)];
  }
  return values.dot(covariance * values);
}

TEST(KernelSandwich, OfOneFlockIsTheCovarianceItself) {
  KernelFlock flock = Small(1);
  flock.noise = 1e-3;
  const KernelDesign design = Design(1, {0, 1, 2, 4}, 3);
  const std::vector<ObservedFlock> one = Flights(flock, 1, 1);
  const Solved solved = Solve(design, one);
  EXPECT_EQ(Sandwich(design, one, solved), solved.evidence.covariance);
}

// The equation of the header, with the scores from moments. Of all terms where V is so wide that
// V_g is wider everywhere, of one term where V_g is less than V, too.
TEST(KernelSandwich, IsWhatTheFlightsScoresMakeIt) {
  for (const int order : {1, 2}) {
    const KernelDesign design = Design(order, {0, 1.5, 4}, 0);
    const std::vector<ObservedFlock> flocks = Flights(Small(order), 8, 2);
    const Index p = design.terms();
    Solved solved{GatherKernelMoments(design, flocks, flocks, 1), {}};
    solved.evidence.coefficients = VectorXd::LinSpaced(p, 0.1, 0.3);  // not the true ones
    solved.evidence.diffusion = 1e-2;
    const MatrixXd meat = Meat(design, flocks, solved.evidence);
    const double least = Widened(MatrixXd::Identity(p, p), meat)[0];
    ASSERT_GT(least, 0);
    solved.evidence.covariance = 2 / least * MatrixXd::Identity(p, p);
    const MatrixXd expected = 4 / (least * least) * meat;
    EXPECT_LT((Sandwich(design, flocks, solved) - expected).norm(), 1e-9 * expected.norm());
  }
  const KernelDesign design = Design(1, {0, 4}, 0);
  const std::vector<ObservedFlock> flocks = Flights(Small(1), 8, 2);
  Solved solved{GatherKernelMoments(design, flocks, flocks, 1), {}};
  solved.evidence.coefficients = VectorXd::Constant(1, 0.1);
  solved.evidence.diffusion = 1e-2;
  const double meat = Meat(design, flocks, solved.evidence)(0, 0);
  for (const double v : {0.5 / meat, 2 / meat}) {
    solved.evidence.covariance = MatrixXd::Constant(1, 1, v);
    EXPECT_NEAR(Sandwich(design, flocks, solved)(0, 0), std::max(v, v * v * meat), 1e-9 * v);
  }
}

// By chance alone V^-1 V_g has eigenvalues up to (1 + sqrt(p / n))^2 about (Marchenko and Pastur),
// p terms of n flights; a tenth more is left to chance. V' is no less than V. The kernel is a
// spline of the design.
TEST(KernelSandwich, OfIndependentRowsStaysNear) {
  const KernelDesign design = Design(1, {0, 1, 2, 4}, 3);
  constexpr int kFlights = 150;
  const double edge = std::pow(1 + std::sqrt(static_cast<double>(design.terms()) / kFlights), 2);
  for (const bool seen : {true, false}) {
    KernelFlock flock = Small(1);
    flock.attraction = [](double r) { return 0.3 - 0.1 * std::min(r, 4.0); };
    (seen ? flock.noise : flock.diffusion) = 1e-3;
    const std::vector<ObservedFlock> flocks = Flights(flock, kFlights, 3);
    const Solved solved = Solve(design, flocks);
    const VectorXd wider = Widened(solved.evidence.covariance, Sandwich(design, flocks, solved));
    EXPECT_GT(wider[0], 1 - 1e-9);
    EXPECT_LT(wider[wider.size() - 1], 1.1 * edge);
    EXPECT_LT(wider.mean(), 1.25);
  }
}

// Fits to new flights scatter by much more than V, and by V', where a flight's rows err together.
void ExpectScatter(const KernelFlock& flock,
                   const std::function<void(Rng*, KernelFlock*)>& of_flight) {
  constexpr int kDraws = 60, kFlights = 24;
  const KernelDesign design = Design(1, {0, 1, 2, 4}, 3);
  for (const double r : {0.8, 1.5, 2.5}) {
    double sum = 0, squares = 0, alone = 0, widened = 0;
    for (std::uint64_t draw = 1; draw <= kDraws; ++draw) {
      const std::vector<ObservedFlock> flocks = Flights(flock, kFlights, draw, of_flight);
      const Solved solved = Solve(design, flocks);
      const VectorXd& c = solved.evidence.coefficients;
      const double value = design.attraction.Value(std::vector<double>(c.begin(), c.end()), r);
      sum += value;
      squares += value * value;
      alone += VarianceAt(design.attraction, solved.evidence.covariance, r) / kDraws;
      widened += VarianceAt(design.attraction, Sandwich(design, flocks, solved), r) / kDraws;
    }
    const double scatter = (squares - sum * sum / kDraws) / (kDraws - 1);
    EXPECT_LT(alone, 0.15 * scatter) << r;
    EXPECT_GT(widened, 0.5 * scatter) << r;
    EXPECT_LT(widened, 1.6 * scatter) << r;
  }
}

TEST(KernelSandwich, IsAsWideAsFlightsOfUnlikeStrengthScatter) {
  KernelFlock flock = Small(1);
  flock.noise = 1e-3;
  ExpectScatter(flock, [](Rng* rng, KernelFlock* flown) {
    const double strength = 1 + 0.3 * rng->Normal();
    flown->attraction = [strength](double r) { return strength * Curved(r); };
  });
}

TEST(KernelSandwich, IsAsWideAsFlightsThatArePushedScatter) {
  KernelFlock flock = Small(1);
  flock.noise = 1e-3;
  flock.drift = 0.05;
  ExpectScatter(flock, nullptr);
}

TEST(KernelSandwich, IsTheSameOnAnyNumberOfThreads) {
  KernelFlock flock = Small(2);
  flock.alignment = Curved;
  flock.diffusion = 1e-3;
  const KernelDesign design = Design(2, {0, 1, 2, 4}, 3);
  const std::vector<ObservedFlock> flocks = Flights(flock, 7, 4);
  const Solved solved = Solve(design, flocks);
  const MatrixXd one = Sandwich(design, flocks, solved, 1);
  EXPECT_NE(one, solved.evidence.covariance);
  for (const int threads : {2, 5}) EXPECT_EQ(Sandwich(design, flocks, solved, threads), one);
}

}  // namespace
}  // namespace flocklift
