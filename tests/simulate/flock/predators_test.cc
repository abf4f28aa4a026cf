// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/predators.h"

#include <gtest/gtest.h>

#include <limits>

namespace flocklift {
namespace {

Vec3d Nowhere(const Vec3d& from) { return from; }

const Region kBox{{-10, -10, 0}, {10, 10, 20}};

TEST(Predators, WanderAtTheirSpeedNearTheBox) {
  Predators predators(
      {{.count = 3, .speed = 8, .fear_radius = 1, .fear_weight = 1, .turn_interval = 1}}, kBox, 3,
      5);
  ASSERT_EQ(predators.all().size(), 3U);
  const Vec3d first_heading = predators.all()[0].heading;
  bool turned = false;
  for (std::uint32_t step = 0; step < 5000; ++step) {
    predators.Step(0.01, step, Nowhere);
    turned = turned || Dot(predators.all()[0].heading, first_heading) < 0;
    for (const Predator& p : predators.all()) {
      EXPECT_LT(Norm(p.position - kBox.Center()), 30);
      EXPECT_LT(Norm(p.velocity), 8.001);
    }
  }
  EXPECT_TRUE(turned);
  EXPECT_GT(Norm(predators.all()[0].velocity), 2);
}

TEST(Predators, SameSeedSamePaths) {
  const auto end = [](std::uint64_t seed) {
    Predators predators({PredatorSpec{}}, kBox, 2, seed);
    for (std::uint32_t step = 0; step < 500; ++step) predators.Step(0.01, step, Nowhere);
    EXPECT_EQ(predators.all()[0].position.z, 0);
    return predators.all()[0].position;
  };
  EXPECT_EQ(end(1), end(1));
  EXPECT_NE(end(1), end(2));
}

TEST(Predators, NeedABox) {
  const double far = std::numeric_limits<double>::infinity();
  EXPECT_THROW(Predators({PredatorSpec{}}, {{-far, 0, 0}, {1, 1, 1}}, 3, 1), std::invalid_argument);
  EXPECT_TRUE(Predators({}, {{-far, 0, 0}, {1, 1, 1}}, 3, 1).all().empty());
}

TEST(Predators, ChasersCatchWhatStandsStill) {
  const Vec3d prey{4, -3, 7};
  Predators predators({PredatorSpec{.chases = true, .count = 3, .speed = 6}},
                      {{-10, -10, 0}, {10, 10, 10}}, 3, 5);
  std::vector<double> nearest(3, 1e9);
  for (std::uint32_t step = 0; step < 1000; ++step) {
    predators.Step(0.01, step, [&prey](const Vec3d&) { return prey; });
    for (std::size_t k = 0; k < 3; ++k) {
      nearest[k] = std::min(nearest[k], Norm(predators.all()[k].position - prey));
    }
  }
  for (const double distance : nearest) EXPECT_LT(distance, 3);
}

}  // namespace
}  // namespace flocklift
