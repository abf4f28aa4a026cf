// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/predict/motion_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/track/pictures.h"

namespace flocklift {
namespace {

constexpr int kAnimals = 30, kFrames = 60;

// Constant velocity with white acceleration of the given strength; all of sd 2 px.
std::vector<std::vector<SoftBlob>> Fly(double q, double noise, std::uint64_t seed) {
  std::vector<std::vector<SoftBlob>> frames(kFrames);
  for (std::uint64_t k = 0; k < kAnimals; ++k) {
    Rng rng(seed, k);
    Vec2d p{100.0 + 250 * static_cast<double>(k % 6), 100.0 + 250 * static_cast<double>(k / 6)};
    Vec2d v{rng.Uniform(-3, 3), rng.Uniform(-3, 3)};
    for (auto& frame : frames) {
      const double ax = std::sqrt(q) * rng.Normal(), ay = std::sqrt(q) * rng.Normal();
      p = {p.x + v.x + 0.5 * ax, p.y + v.y + 0.5 * ay};
      v = {v.x + ax, v.y + ay};
      frame.push_back({.center = {p.x + noise * rng.Normal(), p.y + noise * rng.Normal()}});
    }
  }
  return frames;
}

std::vector<BlobFrame> Found(const std::vector<std::vector<SoftBlob>>& frames) {
  std::vector<BlobFrame> found;
  for (const auto& frame : frames) {
    found.push_back(BlobsOf(static_cast<int>(found.size()) + 1, frame));
  }
  return found;
}

TEST(UnmistakablePathsTest, AreTheTruePaths) {
  const auto frames = Fly(0.01, 0.1, 2);
  const std::vector<Path> paths = UnmistakablePaths(Found(frames), 10);
  ASSERT_GE(paths.size(), 20u);
  for (const Path& path : paths) {
    // All its positions are of one animal, in consecutive frames.
    bool found = false;
    for (int k = 0; k < kAnimals && !found; ++k) {
      for (std::size_t start = 0; start + path.positions.size() <= frames.size(); ++start) {
        bool same = true;
        for (std::size_t t = 0; t < path.positions.size() && same; ++t) {
          same = frames[start + t][k].center == path.positions[t];
        }
        found = found || same;
      }
    }
    EXPECT_TRUE(found);
  }
}

TEST(UnmistakablePathsTest, LeaveOutWhatStandsStill) {
  std::vector<std::vector<SoftBlob>> frames(30);
  Rng rng(4);
  for (auto& frame : frames) {
    frame.push_back({.center = {50 + 0.2 * rng.Normal(), 50 + 0.2 * rng.Normal()}});
  }
  EXPECT_TRUE(UnmistakablePaths(Found(frames), 10).empty());
}

class RecoversNoise : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(RecoversNoise, WithinAFactor) {
  const auto [q, noise] = GetParam();
  const std::vector<Path> paths = UnmistakablePaths(Found(Fly(q, noise, 9)), 10);
  const MotionNoise learned = EstimateMotionNoise(paths, {});
  const double size = paths.front().size;
  EXPECT_GT(learned.ProcessVariance(size), q / 6);
  EXPECT_LT(learned.ProcessVariance(size), q * 6);
  EXPECT_GT(learned.MeasurementVariance(size), noise * noise / 3);
  EXPECT_LT(learned.MeasurementVariance(size), noise * noise * 3);
}

INSTANTIATE_TEST_SUITE_P(Bank, RecoversNoise,
                         testing::Values(std::pair{0.01, 0.3}, std::pair{0.2, 0.3},
                                         std::pair{0.05, 1.0}));

// Paths with Singer's acceleration, in steps of a twentieth of a frame.
std::vector<Path> Curved(double correlation, double acceleration_sd, double noise) {
  constexpr int kSteps = 20;
  std::vector<Path> paths;
  for (std::uint64_t k = 0; k < kAnimals; ++k) {
    Rng rng(12, k);
    Path path{4, {}};
    const double keep = std::exp(-1 / (correlation * kSteps));
    const double kick = acceleration_sd * std::sqrt(1 - keep * keep);
    Vec2d p{0, 0}, v{rng.Uniform(-3, 3), rng.Uniform(-3, 3)};
    Vec2d a{acceleration_sd * rng.Normal(), acceleration_sd * rng.Normal()};
    for (int frame = 0; frame < kFrames; ++frame) {
      for (int step = 0; step < kSteps; ++step) {
        a = {keep * a.x + kick * rng.Normal(), keep * a.y + kick * rng.Normal()};
        v = {v.x + a.x / kSteps, v.y + a.y / kSteps};
        p = {p.x + v.x / kSteps, p.y + v.y / kSteps};
      }
      path.positions.push_back({p.x + noise * rng.Normal(), p.y + noise * rng.Normal()});
    }
    paths.push_back(path);
  }
  return paths;
}

TEST(MotionNoiseTest, FindsOutWhetherAccelerationsStayAlike) {
  for (const double correlation : {4.0, 10.0}) {
    constexpr double kAccelerationSd = 0.6, kNoise = 0.2;
    const std::vector<Path> paths = Curved(correlation, kAccelerationSd, kNoise);
    const MotionNoise learned = EstimateMotionModel(paths, EstimateMotionNoise(paths, {}));
    EXPECT_GE(learned.correlation, correlation / 2.5);
    EXPECT_LE(learned.correlation, correlation * 2.5);
    const double variance = AccelerationVariance(learned.ProcessVariance(4), learned.correlation);
    EXPECT_GT(std::sqrt(variance), kAccelerationSd / 2);
    EXPECT_LT(std::sqrt(variance), kAccelerationSd * 2);
  }
  // White acceleration has no memory.
  const std::vector<Path> white = UnmistakablePaths(Found(Fly(0.2, 0.3, 9)), 10);
  EXPECT_EQ(EstimateMotionModel(white, EstimateMotionNoise(white, {})).correlation, 0);
}

TEST(MotionNoiseTest, NothingToLearnFromKeepsTheStart) {
  const MotionNoise start{.acceleration = 0.3, .measurement = 0.2};
  const MotionNoise learned = EstimateMotionNoise({}, start);
  EXPECT_EQ(learned.acceleration, 0.3);
  EXPECT_EQ(learned.measurement, 0.2);
}

}  // namespace
}  // namespace flocklift
