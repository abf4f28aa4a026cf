// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/crowd_start.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "reconstruct/fit/engine_flight.h"
#include "tests/reconstruct/fit/scene_flocks.h"

namespace flocklift {
namespace {

std::vector<TrajectoryPoint> Path(const std::vector<double>& x) {
  std::vector<TrajectoryPoint> path;
  for (std::size_t k = 0; k < x.size(); ++k) {
    TrajectoryPoint point;
    point.frame = static_cast<int>(k) + 1;
    point.position = {x[k], 0, 0};
    path.push_back(point);
  }
  return path;
}

// At 10 frames/s: 2 m/s before frame 2, 4 m/s after it.
TEST(CrowdStart, AVelocityIsThatOfTheLastStep) {
  const std::vector<TrajectoryPoint> path = Path({0, 0.2, 0.6});
  const ArrivalVelocity one = VelocityOfArrival(path, 1, 10, 1);  // of all of the frame before
  EXPECT_NEAR(one.mean.x, 2, 1e-12);
  EXPECT_NEAR(one.doubt.x, 1, 1e-12);
  EXPECT_NEAR(VelocityOfArrival(path, 1, 10, 4).mean.x, 2.75, 1e-12);  // 1/8 of a frame before
  EXPECT_NEAR(VelocityOfArrival(path, 0, 10, 4).mean.x, 2, 1e-12);     // nothing is before
  EXPECT_NEAR(VelocityOfArrival(path, 2, 10, 4).mean.x, 4, 1e-12);
  EXPECT_EQ(VelocityOfArrival(Path({1}), 0, 10, 4).mean.x, 0);
}

// It is looked at every 0.1 s; a frame is 0.04 s, so every third step.
TEST(CrowdStart, IsWhenTheCrowdIsLookedAt) {
  ModelSpec crowd;
  crowd.name = "crowd";
  std::vector<FramePositions> frames(10);
  for (std::size_t f = 0; f < frames.size(); ++f) frames[f].id.resize(f == 7 || f == 0 ? 3 : 2);
  EXPECT_EQ(CrowdStartFrame(frames, crowd, 0, 1, 0.04), 3U);
  EXPECT_EQ(CrowdStartFrame(frames, crowd, 25, 1, 0.04), 2U);
  EXPECT_EQ(CrowdStartFrame(frames, crowd, 2, 1, 0.04), 7U);  // fuller than frames 1 and 4
  EXPECT_EQ(CrowdStartFrame(frames, crowd, 0, 4, 0.01), 5U);  // every tenth step, four a frame
  crowd.parameters["interval"] = 0;
  EXPECT_EQ(CrowdStartFrame(frames, crowd, 0, 4, 0.01), 7U);
  crowd.parameters["interval"] = 100;  // never again: the fullest
  EXPECT_EQ(CrowdStartFrame(frames, crowd, 1, 1, 0.04), 0U);
}

// rms over statistics, quantiles and seeds of how far flights with the true numbers are off the
// flock they start from, in their own spread from seed to seed.
double MisfitOfTruth(double warmup, double fps, int substeps) {
  constexpr int kSeeds = 4, kFlights = 12;
  double sum = 0, count = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Scene scene = CrowdScene();
    scene.seed = seed;
    scene.warmup = warmup;
    scene.fps = fps;
    scene.substeps = substeps;
    const Trajectories flock = Fly(scene);
    const std::vector<FramePositions> frames = internal::FramesOf(flock);
    const FitProblem problem = ProblemOf(scene);
    const internal::FlightStart start =
        internal::MakeFlightStart({.statistics_time = 0}, problem, frames, flock, fps);
    const auto data =
        ComputeMotionStatistics(std::span(frames).subspan(start.first, start.frames), 1 / fps);
    std::vector<MotionStatistics> flown;
    for (std::uint64_t of = 0; of < kFlights; ++of) {
      const auto flight = internal::Fly(start, problem.model, 1, 1000 + of);
      flown.push_back(ComputeMotionStatistics(*flight, 1 / fps).value());
    }
    constexpr std::size_t kEach = kMotionQuantiles.size();
    for (std::size_t q = 0; q < 5 * kEach; ++q) {
      double mean = 0, variance = 0, largest = 0;
      for (const MotionStatistics& s : flown) mean += s[q] / kFlights;
      for (const MotionStatistics& s : flown) variance += std::pow(s[q] - mean, 2) / (kFlights - 1);
      for (std::size_t k = 0; k < kEach; ++k) {
        largest = std::max(largest, (*data)[q / kEach * kEach + k]);
      }
      sum += std::pow(mean - (*data)[q], 2) / std::max(variance, std::pow(3e-3 * largest, 2));
      count += 1;
    }
  }
  return std::sqrt(sum / count);
}

// 3.4, over such settings, where flights started by differences, all alike, in any frame.
TEST(CrowdStart, FlightsOfTheTruthMoveAsTheCrowdDid) {
  EXPECT_LT(MisfitOfTruth(0, 10, 1), 1.2);
  EXPECT_LT(MisfitOfTruth(1, 25, 1), 1.2);
  EXPECT_LT(MisfitOfTruth(1, 25, 4), 1.2);
}

}  // namespace
}  // namespace flocklift
