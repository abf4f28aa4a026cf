// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/depth_paths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "reconstruct/fit/depth_noise.h"
#include "reconstruct/fit/state_space.h"
#include "tests/reconstruct/fit/flocks.h"
#include "tests/reconstruct/fit/linear_flock.h"

namespace flocklift {
namespace {

constexpr double kSd = 0.2, kTime = 2;  // [m], [s]

// The reference flock, seen from 20 m away.
Trajectories Distant(const LinearFlock& flock) {
  Trajectories seen = flock.seen;
  seen.has_sd_depth = true;
  for (Trajectory& trajectory : seen.trajectories) {
    for (TrajectoryPoint& point : trajectory.points) {
      point.position.y += 20;
      point.sd_depth = kSd;
    }
  }
  return seen;
}

ObservedFlock Observed(const Trajectories& seen) { return {seen, seen.fps.value(), 5}; }

DepthErrors ErrorsOf(const ObservedFlock& flock, double scale_sd = 0) {
  return {.sight = [&](int a, int f) { return flock.Position(a, f); },
          .own = [&](int a, int f) { return kSd / Norm(flock.Position(a, f)); },
          .scale_sd = scale_sd,
          .time = kTime};
}

DepthPaths PathsOf(const ObservedFlock& flock, const FilterInput& input, double scale_sd = 0) {
  return {ErrorsOf(flock, scale_sd), input};
}

TEST(DepthPaths, TheirCovarianceIsThatOfTheProcess) {
  const Trajectories seen = Distant(FlyLinearFlock(1, 1300, 2));  // 6.5 s
  const ObservedFlock flock = Observed(seen);
  const FilterInput input(flock);
  const DepthPaths paths = PathsOf(flock, input);
  EXPECT_EQ(paths.size(), 2 * 6U);  // every 1.3 s of 6.5 s
  EXPECT_EQ(UnknownDepthErrors(ErrorsOf(flock), input), paths.size());
  EXPECT_EQ(UnknownDepthErrors(ErrorsOf(flock, 0.1), input), paths.size() + 1);
  const std::size_t frames = input.frames().size(), later = 300;
  double own = 0, apart = 0;  // covariances of animal 0 in frame 0 and `later` frames on
  double between = 0;
  for (std::size_t k = 0; k < paths.size(); ++k) {
    std::vector<double> z(paths.size());
    z[k] = 1;
    const FilterInput moved = paths.Without(input, z);
    const auto error = [&](std::size_t frame, std::size_t animal) {
      const Vec3d& before = input.frames()[frame][animal].position;
      const Vec3d change = before - moved.frames()[frame][animal].position;
      EXPECT_NEAR(Norm(Cross(change, before)), 0, 1e-9);  // along the line of sight
      return Dot(change, before) / Norm(before) / kSd;
    };
    own += error(100, 0) * error(100, 0);
    apart += error(100, 0) * error(100 + later, 0);
    between += error(100, 0) * error(100, 1);
  }
  ASSERT_EQ(frames, 1300U);
  EXPECT_NEAR(own, 1, 2e-3);
  const double dt = static_cast<double>(later) * LinearFlock::kDt;
  EXPECT_NEAR(apart, std::exp(-dt * dt / (2 * kTime * kTime)), 2e-3);
  EXPECT_NEAR(between, 0, 1e-12);
}

// By the determinant of a position's own map, whose shares are of a constant sd.
TEST(DepthPaths, TheVolumeIsThatOfTheMapOfPositions) {
  Trajectories seen = Distant(FlyLinearFlock(1, 3, 2));
  seen.trajectories.pop_back();
  const auto moved = [&](const Vec3d& at, std::span<const double> z) {
    Trajectories one = seen;
    one.trajectories[0].points[1].position = at;
    const ObservedFlock flock = Observed(one);
    const FilterInput input(flock);
    return PathsOf(flock, input, 0.05).Without(input, z).frames()[1][0].position;
  };
  const ObservedFlock flock = Observed(seen);
  const FilterInput input(flock);
  const DepthPaths paths = PathsOf(flock, input, 0.05);
  std::vector<double> z(paths.size());
  for (std::size_t k = 0; k < z.size(); ++k) z[k] = k % 2 == 0 ? 1.5 : -2.5;
  const Vec3d at = seen.trajectories[0].points[1].position;
  Vec3d column[3];
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3d step{axis == 0 ? 1e-5 : 0, axis == 1 ? 1e-5 : 0, axis == 2 ? 1e-5 : 0};
    column[axis] = (moved(at + step, z) - moved(at - step, z)) / 2e-5;
  }
  const double determinant = Dot(column[0], Cross(column[1], column[2]));
  // The three frames' positions and errors are nearly the same.
  EXPECT_NEAR(paths.LogVolume(z), 3 * std::log(determinant), 0.1 * std::abs(std::log(determinant)));

  std::vector<double> gradient(z.size()), second(z.size() * z.size());
  paths.AddVolume(z, gradient, second);
  for (std::size_t k = 0; k < z.size(); ++k) {
    std::vector<double> high = z, low = z;
    high[k] += 1e-3;
    low[k] -= 1e-3;
    const double up = paths.LogVolume(high), down = paths.LogVolume(low);
    EXPECT_NEAR(gradient[k], -(up - down) / 2e-3, 1e-6);
    EXPECT_NEAR(second[k * z.size() + k], -(up + down - 2 * paths.LogVolume(z)) / 1e-6, 1e-5);
  }
  z[0] = 25;  // behind the eye
  EXPECT_EQ(paths.LogVolume(z), -std::numeric_limits<double>::infinity());
  EXPECT_THROW(paths.Without(input, std::vector<double>(1)), std::invalid_argument);
}

StateSpaceFit Fit(const FilterInput& input, const DepthPaths* paths, int threads = 2) {
  ModelSpec model;
  model.name = "linear";
  const ProcessModel process = MakeProcessModel(model, {"cohesion", "alignment"});
  return FitStateSpace({.filter = {}, .threads = threads}, process, {0.03, 0.15}, input, paths);
}

TEST(DepthPaths, AnEstimateThatKnowsOfThemIsRightAndSaysHowFar) {
  double without = 0, with = 0, squares = 0, count = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Trajectories seen = AddDepthNoise({.time = kTime, .scale_sd = 0, .seed = seed, .draw = 0},
                                            {}, 200, Distant(FlyLinearFlock(seed, 400, 6)));
    const ObservedFlock flock = Observed(seen);
    const FilterInput input(flock);
    const DepthPaths paths = PathsOf(flock, input);
    const StateSpaceFit wrong = Fit(input, nullptr), right = Fit(input, &paths);
    ASSERT_EQ(right.status, StateSpaceStatus::kOk);
    EXPECT_EQ(right.depth_errors.size(), paths.size());
    for (std::size_t p = 0; p < 2; ++p) {
      const double truth = p == 0 ? LinearFlock::kCohesion : LinearFlock::kAlignment;
      without += (wrong.estimate[p] - truth) / truth;
      with += (right.estimate[p] - truth) / truth;
      squares += std::pow((right.estimate[p] - truth) / right.sd[p], 2);
      count += 1;
      EXPECT_GT(right.sd[p], wrong.sd[p]);
    }
  }
  EXPECT_LT(without / count, -0.15);
  EXPECT_LT(std::abs(with / count), -0.75 * without / count);
  EXPECT_LT(squares / count, 2);
}

TEST(DepthPaths, AnEstimateWithThemIsTheSameAtAnyNumberOfThreads) {
  const Trajectories seen = AddDepthNoise({.time = kTime, .scale_sd = 0, .seed = 3, .draw = 0}, {},
                                          200, Distant(FlyLinearFlock(3, 100, 3)));
  const ObservedFlock flock = Observed(seen);
  const FilterInput input(flock);
  const DepthPaths paths = PathsOf(flock, input);
  const StateSpaceFit one = Fit(input, &paths, 1), three = Fit(input, &paths, 3);
  EXPECT_EQ(one.estimate, three.estimate);
  EXPECT_EQ(one.sd, three.sd);
  EXPECT_EQ(one.depth_errors, three.depth_errors);
}

}  // namespace
}  // namespace flocklift
