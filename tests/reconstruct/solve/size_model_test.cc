// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/size_model.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

namespace flocklift::internal {
namespace {

constexpr SizeModel kBody{{-0.3, 0.1}, {-1.2, 0.4}, {-1.6, 0.6}};
constexpr SizeModel kStiff{{0.1, 0.15}, {0, 0.1}, {0, 0.1}};

double Squared(double x, const Uncertain& prior) {
  return std::pow((x - prior.mean) / prior.sd, 2);
}

// The posterior of a linear measurement of all three under a prior.
struct Measured {
  Eigen::Matrix3d information;  // of the measurement alone
  Eigen::Vector3d value;
  Eigen::Vector3d mean;
  Eigen::Matrix3d covariance;

  Measured(const Eigen::Matrix3d& information_in, const Eigen::Vector3d& value_in,
           const SizeModel& prior)
      : information(information_in), value(value_in) {
    const Eigen::Vector3d sd(prior.ratio.sd, prior.log_trunk.sd, prior.log_up.sd);
    const Eigen::Vector3d prior_mean(prior.ratio.mean, prior.log_trunk.mean, prior.log_up.mean);
    const Eigen::Matrix3d own = sd.cwiseAbs2().cwiseInverse().asDiagonal();
    covariance = (information + own).inverse();
    mean = covariance * (information * value + own * prior_mean);
  }

  // log of the integral of likelihood times prior, by a sum over a grid.
  double LogIntegral(const SizeModel& prior) const {
    constexpr int kSteps = 60;
    double sum = 0;
    const auto at = [](const Uncertain& u, int k) {
      return u.mean + u.sd * (12.0 * (k + 0.5) / kSteps - 6);
    };
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        for (int k = 0; k < kSteps; ++k) {
          const Eigen::Vector3d x(at(prior.ratio, i), at(prior.log_trunk, j), at(prior.log_up, k));
          const Eigen::Vector3d off = x - value;
          sum += std::exp(-0.5 * (off.dot(information * off) + Squared(x[0], prior.ratio) +
                                  Squared(x[1], prior.log_trunk) + Squared(x[2], prior.log_up)));
        }
      }
    }
    return std::log(sum);
  }
};

Eigen::Matrix3d SomeInformation() {
  Eigen::Matrix3d information;
  information << 90, 20, -8, 20, 15, 3, -8, 3, 6;
  return information;
}

TEST(SizeModelTest, EvidenceIsTheIntegralOfLikelihoodTimesPrior) {
  const Measured measured(SomeInformation(), {-0.1, -0.5, -0.4}, kBody);
  const SizeLikelihood likelihood(measured.mean, measured.covariance, kBody);
  EXPECT_NEAR(likelihood.LogEvidence(kStiff) - likelihood.LogEvidence(kBody),
              measured.LogIntegral(kStiff) - measured.LogIntegral(kBody), 1e-4);
}

TEST(SizeModelTest, EvidenceDoesNotDependOnThePriorItWasFoundWith) {
  const Measured with_body(SomeInformation(), {-0.1, -0.5, -0.4}, kBody);
  const Measured with_stiff(SomeInformation(), {-0.1, -0.5, -0.4}, kStiff);
  const SizeLikelihood a(with_body.mean, with_body.covariance, kBody);
  const SizeLikelihood b(with_stiff.mean, with_stiff.covariance, kStiff);
  EXPECT_NEAR(a.LogEvidence(kStiff), b.LogEvidence(kStiff), 1e-8);
  EXPECT_NEAR(a.LogEvidence(kBody), b.LogEvidence(kBody), 1e-8);
}

TEST(SizeModelTest, WithoutDataTheFormDecides) {
  const Measured nothing(Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero(), kBody);
  const SizeLikelihood likelihood(nothing.mean, nothing.covariance, kBody);
  EXPECT_NEAR(likelihood.LogEvidence(kStiff), 0, 1e-9);
  double last = 1;
  for (const double sd : {0.0, 0.01, 0.05, 0.1, 0.2, 0.4}) {
    const double p = ProbabilityOfStiff(likelihood, {.sd = sd}, kBody, kStiff);
    EXPECT_LE(p, last) << sd;
    last = p;
  }
  EXPECT_GT(ProbabilityOfStiff(likelihood, {.sd = 0}, kBody, kStiff), 0.99);
  EXPECT_LT(ProbabilityOfStiff(likelihood, {.sd = 0.3}, kBody, kStiff), 0.01);
}

TEST(SizeModelTest, DataOutweighTheForm) {
  const Eigen::Matrix3d sharp = Eigen::Vector3d(400, 200, 100).asDiagonal();
  const Measured ball(sharp, {0.1, 0, 0}, kBody), bird(sharp, {-0.3, -1.2, -1.6}, kBody);
  EXPECT_GT(ProbabilityOfStiff({ball.mean, ball.covariance, kBody}, {.sd = 0.1}, kBody, kStiff),
            0.99);
  EXPECT_LT(ProbabilityOfStiff({bird.mean, bird.covariance, kBody}, {.sd = 0.05}, kBody, kStiff),
            0.01);
}

// Boxes of one form whose sizes go with the headings as a bird's do are a bird's.
TEST(SizeModelTest, AFormThatNeverChangesIsNotTheLastWord) {
  const Eigen::Matrix3d sharp = Eigen::Vector3d(400, 200, 100).asDiagonal();
  const Measured bird(sharp, {-0.3, -1.2, -1.6}, kBody);
  EXPECT_LT(ProbabilityOfStiff({bird.mean, bird.covariance, kBody}, {.sd = 0}, kBody, kStiff),
            0.01);
}

TEST(SizeModelTest, AMixtureHasTheMomentsOfBoth) {
  const SizeModel none = Mixture(0, kBody, kStiff), all = Mixture(1, kBody, kStiff);
  EXPECT_EQ(none.log_up.mean, kBody.log_up.mean);
  EXPECT_NEAR(none.log_up.sd, kBody.log_up.sd, 1e-12);
  EXPECT_NEAR(all.ratio.mean, kStiff.ratio.mean, 1e-12);
  EXPECT_NEAR(all.ratio.sd, kStiff.ratio.sd, 1e-12);
  const SizeModel some = Mixture(0.25, kBody, kStiff);
  EXPECT_NEAR(some.ratio.mean, -0.2, 1e-12);
  // E x^2 - (E x)^2
  EXPECT_NEAR(some.ratio.sd, std::sqrt(0.75 * (0.01 + 0.09) + 0.25 * (0.0225 + 0.01) - 0.2 * 0.2),
              1e-12);
}

TEST(SizeModelTest, TheLongerSideOfAStiffBoxIsTheWingspan) {
  EXPECT_EQ(StiffSizes({.log_diagonal = 0.2}).ratio.mean, 0.2);
}

}  // namespace
}  // namespace flocklift::internal
