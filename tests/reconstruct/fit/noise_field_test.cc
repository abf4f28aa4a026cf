// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/noise_field.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <cstdint>

#include "reconstruct/fit/fit.h"
#include "simulate/core/check.h"
#include "simulate/core/rng.h"
#include "simulate/fields/curl_noise.h"
#include "simulate/fields/lattice.h"
#include "tests/reconstruct/fit/flocks.h"

namespace flocklift {
namespace {

VelocitySample Drifters(std::uint32_t seed, int count, double scale, double gain, double rest,
                        double half_width) {
  VelocitySample sample;
  const NoiseTerm<double> term{gain, scale, seed};
  Rng rng(seed, 7);
  for (int k = 0; k < count; ++k) {
    const Vec3d x{rng.Uniform(-half_width, half_width), rng.Uniform(-half_width, half_width),
                  rng.Uniform(1, 1 + 2 * half_width)};
    sample.position.push_back(x);
    sample.velocity.push_back(CurlNoise(term, x) +
                              rest * Vec3d{rng.Normal(), rng.Normal(), rng.Normal()});
  }
  return sample;
}

Eigen::VectorXd Stacked(const VelocitySample& sample) {
  Eigen::VectorXd y(static_cast<Eigen::Index>(3 * sample.size()));
  for (std::size_t k = 0; k < sample.size(); ++k) {
    const Vec3d& v = sample.velocity[k];
    y.segment<3>(static_cast<Eigen::Index>(3 * k)) = Eigen::Vector3d(v.x, v.y, v.z);
  }
  return y;
}

Eigen::MatrixXd DenseSigma(const VelocitySample& sample, double scale, double r) {
  const Eigen::MatrixXd design = MakeNoiseDesign(sample.position, scale).matrix;
  Eigen::VectorXd variance(design.cols());
  for (Eigen::Index c = 0; c < variance.size(); ++c) variance[c] = c % 3 == 1 ? 0.75 : 0.625;
  return Eigen::MatrixXd::Identity(design.rows(), design.rows()) +
         r * design * variance.asDiagonal() * design.transpose();
}

TEST(NoiseDesign, IsTheSimulatorsNoiseForTheGradientsThatItsHashChooses) {
  const VelocitySample sample = Drifters(5, 30, 0.7, 1.3, 0, 2);
  const NoiseDesign design = MakeNoiseDesign(sample.position, 0.7);
  Eigen::VectorXd g(design.matrix.cols());
  for (std::size_t m = 0; m < design.lattice.size(); ++m) {
    const LatticePoint& p = design.lattice[m];
    const std::uint32_t bits =
        LatticeHash{5}(static_cast<std::uint32_t>(p[0]), static_cast<std::uint32_t>(p[1]),
                       static_cast<std::uint32_t>(p[2]));
    for (int noise = 0; noise < 3; ++noise) {
      for (int a = 0; a < 3; ++a) {
        g[static_cast<Eigen::Index>(9 * m) + 3 * noise + a] =
            0.5 * kDoubledGradients[bits >> LatticeShift(noise) & 15][a];
      }
    }
  }
  EXPECT_LT((1.3 * (design.matrix * g) - Stacked(sample)).norm(), 1e-12);
}

TEST(NoiseDesign, KnowsTheMomentsOfTheSixteenGradients) {
  const std::array<double, 3> variance = GradientVariance();
  EXPECT_DOUBLE_EQ(variance[0], 10.0 / 16);
  EXPECT_DOUBLE_EQ(variance[1], 12.0 / 16);
  EXPECT_DOUBLE_EQ(variance[2], 10.0 / 16);
  const std::array<double, 81> cumulants = GradientCumulants();
  EXPECT_NEAR(cumulants[0], 1 / 0.625 - 3, 1e-12);                  // x x x x
  EXPECT_NEAR(cumulants[40], 1 / 0.75 - 3, 1e-12);                  // y y y y
  EXPECT_NEAR(cumulants[4], 6.0 / 16 / (0.625 * 0.75) - 1, 1e-12);  // x x y y
  EXPECT_NEAR(cumulants[0 * 27 + 0 * 9 + 0 * 3 + 1], 0, 1e-12);     // x x x y
}

TEST(NoiseField, ConstantsAreThoseOfTheNoiseOverSeeds) {
  double products = 0, squares = 0;
  constexpr int kDraws = 40000;
  for (std::uint32_t k = 0; k < kDraws; ++k) {
    Rng rng(3, k);
    const NoiseTerm<double> term{1, 1, rng.Bits()};
    const Vec3d x{rng.Uniform(0, 9), rng.Uniform(0, 9), rng.Uniform(0, 9)};
    const Vec3d way = Normalized(Vec3d{rng.Normal(), rng.Normal(), rng.Normal()});
    const Vec3d v = CurlNoise(term, x);
    products += Dot(v, CurlNoise(term, x + kHalfCorrelation * way));
    squares += SquaredNorm(v);
  }
  EXPECT_NEAR(products / squares, 0.5, 0.01);
}

// Few animals are factored by velocities, many by gradients.
TEST(NoiseEvidence, BothFactorsAreTheDenseLikelihood) {
  for (const int count : {12, 150}) {
    const VelocitySample sample = Drifters(9, count, 1.1, 0.6, 0.02, 1);
    const NoiseEvidence evidence(sample, 1.1);
    const double r = 50;
    const Eigen::MatrixXd sigma = DenseSigma(sample, 1.1, r);
    const Eigen::VectorXd y = Stacked(sample), solved = sigma.ldlt().solve(y);
    const NoiseEvidence::Value value = evidence.At(r);
    EXPECT_NEAR(value.square / y.dot(solved), 1, 1e-9);
    EXPECT_NEAR(value.log_determinant, sigma.ldlt().vectorD().array().log().sum(),
                1e-7 * value.log_determinant);
    EXPECT_LT((evidence.Residual(r) - solved).norm(), 1e-9 * solved.norm());
    const Eigen::MatrixXd s = sigma.inverse();
    const Eigen::MatrixXd away = Eigen::MatrixXd::Identity(y.size(), y.size()) - s;
    EXPECT_NEAR(evidence.ScoreOfGain(r).normal, 2 * (away * away).trace(),
                1e-6 * evidence.ScoreOfGain(r).normal);
  }
}

TEST(NoiseEvidence, ForetellsAnAnimalFromTheOthers) {
  for (const int count : {12, 150}) {
    VelocitySample sample = Drifters(4, count, 1.0, 0.5, 0.05, 1);
    const double r = 20;
    const auto all = NoiseEvidence(sample, 1.0).LeaveOneOut(r);
    ASSERT_EQ(all.size(), sample.size());
    // The last one's velocity given the others', from the joint normal distribution.
    const Eigen::MatrixXd sigma = DenseSigma(sample, 1.0, r);
    const Eigen::Index n = sigma.rows() - 3;
    const Eigen::VectorXd y = Stacked(sample);
    const Eigen::MatrixXd weights =
        sigma.topLeftCorner(n, n).ldlt().solve(sigma.topRightCorner(n, 3));
    const Eigen::Vector3d error = y.tail(3) - weights.transpose() * y.head(n);
    const Eigen::Matrix3d covariance =
        sigma.bottomRightCorner(3, 3) - sigma.bottomLeftCorner(3, n) * weights;
    EXPECT_NEAR(all.back().error_square, error.squaredNorm(), 1e-8);
    EXPECT_NEAR(all.back().standard_square, error.dot(covariance.inverse() * error), 1e-8);
  }
}

// The score's variance over seeds, far from that of normal gradients.
TEST(NoiseEvidence, KnowsHowTheGainsScoreVariesOverSeeds) {
  constexpr int kSeeds = 400;
  const double scale = 1, gain = 0.5, s = 0.02, r = gain * gain / (s * s);
  VelocitySample sample = Drifters(1, 40, scale, gain, 0, 1);
  const Eigen::MatrixXd sigma = DenseSigma(sample, scale, r);
  const Eigen::MatrixXd inverse = sigma.inverse();
  const Eigen::MatrixXd middle = inverse - inverse * inverse;
  double sum = 0, squares = 0;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    Rng rng(seed, 3);
    for (std::size_t k = 0; k < sample.size(); ++k) {
      sample.velocity[k] =
          CurlNoise(NoiseTerm<double>{gain, scale, seed * 2654435761U}, sample.position[k]) +
          s * Vec3d{rng.Normal(), rng.Normal(), rng.Normal()};
    }
    const Eigen::VectorXd y = Stacked(sample);
    const double score = y.dot(middle * y) / (s * s);
    sum += score / kSeeds;
    squares += score * score / kSeeds;
  }
  const auto known = NoiseEvidence(sample, scale).ScoreOfGain(r);
  const double variance = squares - sum * sum;
  EXPECT_NEAR(variance / (known.normal + known.excess), 1, 0.25);
  EXPECT_LT(known.normal + known.excess, 0.7 * known.normal);
}

TEST(NoiseField, RecoversScaleAndGainOverSeedsWithIntervals) {
  constexpr int kSeeds = 6;
  double scale_squares = 0, gain_squares = 0;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const NoiseFieldFit fit =
        FitNoiseField({.coarse_points = 40}, {Drifters(seed, 80, 1.2, 0.5, 0.05, 1.2)});
    ASSERT_TRUE(fit.IsUsable()) << seed;
    EXPECT_NEAR(fit.scale, 1.2, 0.05 * 1.2) << seed;
    EXPECT_NEAR(fit.gain, 0.5, 0.15 * 0.5) << seed;
    EXPECT_NEAR(fit.rest_sd, 0.05, 0.02) << seed;
    scale_squares += std::pow((fit.scale - 1.2) / fit.scale_sd, 2) / kSeeds;
    gain_squares += std::pow((fit.gain - 0.5) / fit.gain_sd, 2) / kSeeds;
  }
  EXPECT_GT(scale_squares, 0.3);
  EXPECT_LT(scale_squares, 2.5);
  EXPECT_GT(gain_squares, 0.1);
  EXPECT_LT(gain_squares, 2.5);
}

TEST(NoiseField, LeavesOutWhatSomethingElseMoves) {
  VelocitySample sample = Drifters(3, 120, 1.2, 0.5, 0.005, 1.2);
  for (std::size_t k = 0; k < sample.size(); k += 40) sample.velocity[k] += Vec3d{0, 0, 0.6};
  const NoiseFieldFit fit = FitNoiseField({.coarse_points = 60}, {sample});
  ASSERT_TRUE(fit.IsUsable());
  EXPECT_GE(fit.left_out, 3U);
  EXPECT_NEAR(fit.scale, 1.2, 0.01);
  EXPECT_NEAR(fit.gain, 0.5, 0.05);
}

TEST(NoiseField, SaysWhenThereIsNone) {
  EXPECT_EQ(FitNoiseField({}, {Drifters(1, 10, 1, 0.5, 0, 1)}).status, NoiseFieldStatus::kTooFew);
  const NoiseFieldFit white = FitNoiseField({.coarse_points = 40}, {Drifters(1, 60, 1, 0, 1, 1)});
  EXPECT_TRUE(!white.IsUsable() || white.gain_sd > 0.25 * white.gain);
}

Scene SwarmScene(double evolution) {
  Scene scene;
  scene.seed = 8;
  scene.fps = 30;
  scene.substeps = 1;
  scene.duration = evolution > 0 ? 2 * evolution + 0.2 : 0.5;
  scene.box = {{-9, -9, -9}, {9, 9, 9}};
  SpeciesSpec midges;
  midges.count = 90;
  midges.start = Region{{-1.5, -1.5, 1}, {1.5, 1.5, 4}};
  midges.model.name = "swarm";
  midges.model.parameters = {{"scale", 1.5}, {"gain", 0.4}, {"evolution", evolution}, {"d_min", 0}};
  scene.species = {midges};
  return scene;
}

FitResult FitSwarm(double evolution, const Scene& scene, int threads) {
  FitProblem problem;
  problem.model.name = "swarm";
  problem.model.parameters["evolution"] = evolution;
  FitOptions options;
  options.noise_animals = 70;
  options.substeps = 1;
  return FitModel(options, problem, Fly(scene), 30, 1, threads);
}

TEST(SwarmNoise, IsFittedToTheSimulatorsSwarmTheSameAtAnyNumberOfThreads) {
  for (const double evolution : {0.0, 1.0}) {
    const Scene scene = SwarmScene(evolution);
    const FitResult one = FitSwarm(evolution, scene, 1), two = FitSwarm(evolution, scene, 2);
    ASSERT_TRUE(one.IsUsable());
    EXPECT_EQ(one.method, FitMethod::kNoiseField);
    ASSERT_EQ(one.weights.size(), 2U);
    EXPECT_TRUE(one.weights[0].determined && one.weights[1].determined);
    EXPECT_NEAR(one.parameters.model.parameters.at("scale"), 1.5, 0.05 * 1.5) << evolution;
    EXPECT_NEAR(one.parameters.model.parameters.at("gain"), 0.4, 0.1 * 0.4) << evolution;
    EXPECT_GT(one.r2, 0.99);
    EXPECT_TRUE(one.warnings.empty());
    EXPECT_EQ(one.weights[0].estimate, two.weights[0].estimate);
    EXPECT_EQ(one.weights[1].sd, two.weights[1].sd);
  }
}

TEST(SwarmNoise, RefusesWhatItCannotFree) {
  const Trajectories flock = Fly(SwarmScene(0));
  FitProblem problem;
  problem.model.name = "swarm";
  problem.free = {"s0"};
  EXPECT_THROW(FitModel({}, problem, flock, 30, 1, 1), InputError);
  problem.free = {"scale"};
  EXPECT_THROW(FitModel({}, problem, flock, 30, 1, 1), InputError);
  problem.free.clear();
  problem.method = FitMethod::kStateSpace;
  EXPECT_THROW(FitModel({}, problem, flock, 30, 1, 1), InputError);
  problem.method = FitMethod::kNoiseField;
  problem.model.name = "boids";
  EXPECT_THROW(FitModel({}, problem, flock, 30, 1, 1), InputError);
}

}  // namespace
}  // namespace flocklift
