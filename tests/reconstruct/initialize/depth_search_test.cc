// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/depth_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace flocklift {
namespace {

DepthSearchPriors Priors() {
  DepthSearchPriors priors;
  priors.log_speed = std::log(10.0);
  priors.log_width = std::log(0.7);
  priors.log_depth = std::log(40.0);
  priors.log_near = std::log(20.0);
  priors.log_far = std::log(80.0);
  return priors;
}

// One sighting with a size is as far as its size says.
TEST(DepthSearch, OneStepBySize) {
  const std::vector<double> depth = SearchDepth(Priors(), 0.25, {{{0.1, 0}, std::log(0.7 / 40)}});
  ASSERT_EQ(depth.size(), 1u);
  EXPECT_NEAR(depth[0], std::log(40.0), 0.02);
}

TEST(DepthSearch, StaysInsideTheGrid) {
  for (double size : {1e-6, 1.0, 1e6}) {
    for (const double l :
         SearchDepth(Priors(), 0.25, std::vector<DepthSearchStep>(5, {{0.1, 0}, std::log(size)}))) {
      EXPECT_GE(l, std::log(20.0) - 1e-12);
      EXPECT_LE(l, std::log(80.0) + 1e-12);
    }
  }
}

// Straight flight away from the camera and towards it, at the known speed, without a size: the
// image slows down or quickens, and the grid tells the two apart.
TEST(DepthSearch, TellsAwayFromTowards) {
  constexpr double kInterval = 0.25;
  for (const double direction : {1.0, -1.0}) {
    std::vector<DepthSearchStep> steps;
    std::vector<double> truth;
    for (int k = 0; k < 20; ++k) {
      const double t = kInterval * k;
      const Vec3d p{-14 + 7 * t, -6, 42 + direction * 7 * (t - 2.5)};
      steps.push_back({{p.x / p.z, p.y / p.z}, std::nullopt});
      truth.push_back(std::log(p.z));
    }
    DepthSearchPriors priors = Priors();
    priors.acceleration_sd = 1;
    const std::vector<double> depth = SearchDepth(priors, kInterval, steps);
    for (std::size_t k = 0; k < truth.size(); ++k) {
      EXPECT_NEAR(depth[k], truth[k], 0.35) << direction << " " << k;
    }
    EXPECT_GT(direction * (depth.back() - depth.front()), 0.4);
  }
}

// On a circle sizes lead the way, however rough.
TEST(DepthSearch, FollowsSizesAroundACircle) {
  constexpr double kInterval = 0.25;
  std::vector<DepthSearchStep> steps;
  std::vector<double> truth;
  for (int k = 0; k < 32; ++k) {
    const double angle = 10.0 / 12 * kInterval * k;
    const Vec3d p{12 * std::cos(angle), -6, 40 + 12 * std::sin(angle)};
    const double error = 0.15 * std::sin(2.7 * k);
    steps.push_back({{p.x / p.z, p.y / p.z}, std::log(0.7 / p.z) + error});
    truth.push_back(std::log(p.z));
  }
  const std::vector<double> depth = SearchDepth(Priors(), kInterval, steps);
  double sum = 0;
  for (std::size_t k = 0; k < truth.size(); ++k) sum += std::abs(depth[k] - truth[k]);
  EXPECT_LT(sum / static_cast<double>(truth.size()), 0.08);  // a constant: 0.2
}

}  // namespace
}  // namespace flocklift
