// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/lagged_regression.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

void Add(RegressionRows* rows, int time, int group, double y, std::vector<double> x,
         std::vector<double> z, double weight = 1) {
  rows->terms = static_cast<int>(x.size());
  rows->response.push_back(y);
  rows->features.insert(rows->features.end(), x.begin(), x.end());
  rows->instruments.insert(rows->instruments.end(), z.begin(), z.end());
  rows->weight.push_back(weight);
  rows->time.push_back(time);
  rows->group.push_back(group);
}

// Underdamped diffusion, dv = -gamma v dt + sqrt(2 d) dW, seen at times k dt as x plus noise; the
// regression of second differences on central velocities, with the velocity before the window as
// instrument, or with itself ("plain").
RegressionRows Damped(std::uint64_t seed, double noise, bool plain) {
  constexpr double kGamma = 1.0, kDiffusion = 0.5, kDt = 0.1;
  constexpr int kAnimals = 5, kFrames = 400, kSubsteps = 10;
  std::vector<std::vector<double>> x(kAnimals);
  for (int i = 0; i < kAnimals; ++i) {
    Rng rng(seed, static_cast<std::uint64_t>(i));
    double position = 0, velocity = std::sqrt(kDiffusion / kGamma) * rng.Normal();
    for (int k = 0; k < kFrames; ++k) {
      x[static_cast<std::size_t>(i)].push_back(position + noise * rng.Normal());
      for (int s = 0; s < kSubsteps; ++s) {
        const double h = kDt / kSubsteps;
        velocity += -kGamma * velocity * h + std::sqrt(2 * kDiffusion * h) * rng.Normal();
        position += velocity * h;
      }
    }
  }
  RegressionRows rows;
  for (int k = 4; k + 1 < kFrames; ++k) {
    for (int i = 0; i < kAnimals; ++i) {
      const auto& p = x[static_cast<std::size_t>(i)];
      const auto at = [&](int f) { return p[static_cast<std::size_t>(f)]; };
      const double a = (at(k + 1) - 2 * at(k) + at(k - 1)) / (kDt * kDt);
      const double v = (at(k + 1) - at(k - 1)) / (2 * kDt);
      Add(&rows, k, i, a, {-v}, {plain ? -v : -(at(k - 2) - at(k - 3)) / kDt});
    }
  }
  return rows;
}

TEST(LaggedRegression, IsLeastSquaresWhenInstrumentsAreTheFeatures) {
  RegressionRows rows;
  Rng rng(7);
  Eigen::MatrixXd x(200, 3);
  Eigen::VectorXd y(200), w(200);
  for (int e = 0; e < 200; ++e) {
    for (int k = 0; k < 3; ++k) x(e, k) = rng.Normal() + 0.3 * k;
    y[e] = 2 * x(e, 0) - x(e, 1) + 0.5 * x(e, 2) + 0.1 * rng.Normal();
    w[e] = rng.Uniform(0.5, 2);
    const std::vector<double> row = {x(e, 0), x(e, 1), x(e, 2)};
    Add(&rows, e / 4, e % 4, y[e], row, row, w[e]);
  }
  const RegressionResult result = SolveRegression(rows);
  ASSERT_TRUE(result.IsUsable());
  const Eigen::VectorXd expected =
      (w.cwiseSqrt().asDiagonal() * x).colPivHouseholderQr().solve(w.cwiseSqrt().cwiseProduct(y));
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(result.estimate[static_cast<std::size_t>(k)], expected[k], 1e-10);
  }
  EXPECT_LT(result.condition, 10);
}

TEST(LaggedRegression, InstrumentsFromThePastRemoveTheBiasOfPlainDifferences) {
  constexpr int kSeeds = 60;
  for (const double noise : {0.0, 0.02}) {
    double plain = 0, lagged = 0, squares = 0;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      plain += SolveRegression(Damped(static_cast<std::uint64_t>(seed), noise, true)).estimate[0];
      const double estimate =
          SolveRegression(Damped(static_cast<std::uint64_t>(seed), noise, false)).estimate[0];
      lagged += estimate;
      squares += estimate * estimate;
    }
    plain /= kSeeds;
    lagged /= kSeeds;
    const double sd_of_mean = std::sqrt((squares / kSeeds - lagged * lagged) / kSeeds);
    EXPECT_NEAR(lagged, 1.0, 3 * sd_of_mean + 0.01) << "noise " << noise;
    EXPECT_LT(plain, 0.6) << "noise " << noise;  // process noise alone takes a half off
  }
}

TEST(LaggedRegression, IntervalsCoverUnderProcessAndPositionNoise) {
  for (const double noise : {0.0, 0.02}) {
    int covered = 0;
    constexpr int kSeeds = 200;
    for (int seed = 1001; seed <= 1000 + kSeeds; ++seed) {
      const RegressionResult r =
          SolveRegression(Damped(static_cast<std::uint64_t>(seed), noise, false));
      covered += std::abs(r.estimate[0] - 1.0) < 1.96 * r.sd[0] ? 1 : 0;
    }
    EXPECT_GE(covered, kSeeds * 0.90) << "noise " << noise;
    EXPECT_LE(covered, kSeeds * 0.99) << "noise " << noise;
  }
}

TEST(LaggedRegression, ErrorsCommonToTheFlockWidenTheIntervals) {
  // 20 animals that share every error know no more than one of them.
  double own = 0, common = 0;
  for (const bool shared : {false, true}) {
    RegressionRows rows;
    for (int t = 0; t < 300; ++t) {
      Rng flock(3, 1000, static_cast<std::uint32_t>(t));
      const double shared_x = flock.Normal(), shared_u = flock.Normal();
      for (int i = 0; i < 20; ++i) {
        Rng rng(3, static_cast<std::uint64_t>(i), static_cast<std::uint32_t>(t));
        const double x = shared ? shared_x : rng.Normal();
        Add(&rows, t, i, x + (shared ? shared_u : rng.Normal()), {x}, {x});
      }
    }
    (shared ? common : own) = SolveRegression(rows).sd[0];
  }
  EXPECT_GT(common, 3 * own);
  EXPECT_LT(common, 6 * own);  // sqrt(20) = 4.5
}

TEST(LaggedRegression, ErrorsThatStayWithAnAnimalWidenTheIntervals) {
  double changing = 0, staying = 0;
  for (const bool stay : {false, true}) {
    RegressionRows rows;
    for (int t = 0; t < 300; ++t) {
      for (int i = 0; i < 20; ++i) {
        Rng animal(4, static_cast<std::uint64_t>(i));
        Rng rng(5, static_cast<std::uint64_t>(i), static_cast<std::uint32_t>(t));
        const double x = animal.Normal(), own_u = animal.Normal();
        Add(&rows, t, i, x + (stay ? own_u : rng.Normal()), {x}, {x});
      }
    }
    (stay ? staying : changing) = SolveRegression(rows).sd[0];
  }
  EXPECT_GT(staying, 8 * changing);  // sqrt(300) = 17
}

TEST(LaggedRegression, SaysWhatTheDataDoNotDetermine) {
  RegressionRows rows;
  Rng rng(5);
  for (int e = 0; e < 300; ++e) {
    const double a = rng.Normal(), b = rng.Normal();
    const std::vector<double> row = {a, b, 2 * b, 0.0};  // the last two are twins and absent
    Add(&rows, e / 3, e % 3, a + b + 0.1 * rng.Normal(), row, row);
  }
  const RegressionResult result = SolveRegression(rows);
  EXPECT_TRUE(std::isfinite(result.sd[0]));
  EXPECT_TRUE(std::isinf(result.sd[1]));
  EXPECT_TRUE(std::isinf(result.sd[2]));
  EXPECT_TRUE(std::isinf(result.sd[3]));
  EXPECT_TRUE(std::isinf(result.condition));
  EXPECT_NEAR(result.estimate[0], 1, 0.05);
  EXPECT_EQ(result.estimate[3], 0);
}

TEST(LaggedRegression, TooLittleDataIsAStatus) {
  RegressionRows rows;
  for (int e = 0; e < 8; ++e) Add(&rows, e, 0, 1, {1.0 + e}, {1.0 + e});
  EXPECT_EQ(SolveRegression(rows).status, RegressionStatus::kTooFewRows);
  for (int e = 8; e < 80; ++e) Add(&rows, 8 + e / 40, 0, 1, {1.0 + e}, {1.0 + e});
  EXPECT_EQ(SolveRegression(rows).status, RegressionStatus::kTooFewTimes);
}

TEST(LaggedRegression, StudentQuantiles) {
  EXPECT_NEAR(StudentQuantile975(4), 2.7764, 0.009);
  EXPECT_NEAR(StudentQuantile975(10), 2.2281, 0.001);
  EXPECT_NEAR(StudentQuantile975(30), 2.0423, 0.0002);
}

}  // namespace
}  // namespace flocklift
