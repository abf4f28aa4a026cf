// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/kernel_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "reconstruct/fit/kernel_modes.h"
#include "simulate/core/rng.h"
#include "tests/reconstruct/fit/kernel_flock.h"

namespace flocklift {
namespace {

double Straight(double r) { return 0.3 - 0.1 * r; }
double Curved(double r) { return 0.4 * std::exp(-r) - 0.3 * std::exp(-2 * r * r); }

std::vector<Trajectories> FlyRuns(const KernelFlock& flock, int runs, std::uint64_t seed) {
  std::vector<Trajectories> flocks;
  for (int run = 0; run < runs; ++run) {
    flocks.push_back(FlyKernels(flock, 1000 * seed + static_cast<std::uint64_t>(run)));
  }
  return flocks;
}

KernelFit Fit(const KernelFitOptions& options, const std::vector<Trajectories>& flocks,
              std::uint64_t seed = 1, int threads = 2) {
  return FitKernels(options, flocks, *flocks[0].fps, seed, threads);
}

KernelFitOptions Small(int order) { return {.order = order, .intervals = 12}; }

// Positions whose differences are exactly what the quadrature makes of the kernel's drive.
Trajectories ExactFlight(int order, const Trajectories& start, double (*phi)(double)) {
  Trajectories flight = start;
  const auto frames = static_cast<Eigen::Index>(start.trajectories[0].points.size());
  const Eigen::MatrixXd q = KernelQuadrature(order, static_cast<int>(frames), 1 / *start.fps);
  const std::size_t n = start.trajectories.size();
  const auto at = [&](std::size_t i, Eigen::Index k) -> Vec3d& {
    return flight.trajectories[i].points[static_cast<std::size_t>(k)].position;
  };
  for (int round = 0; round < 200; ++round) {
    std::vector<std::vector<Vec3d>> drive(n, std::vector<Vec3d>(static_cast<std::size_t>(frames)));
    for (Eigen::Index k = 0; k < frames; ++k) {
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
          if (j == i) continue;
          const Vec3d dx = at(j, k) - at(i, k);
          drive[i][static_cast<std::size_t>(k)] += phi(Norm(dx)) * dx;
        }
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (Eigen::Index k = 0; k < q.rows(); ++k) {
        Vec3d change;
        for (Eigen::Index m = 0; m < frames; ++m) {
          change += q(k, m) * drive[i][static_cast<std::size_t>(m)];
        }
        if (order == 1) {
          at(i, k + 1) = at(i, k) + change;
        } else {
          at(i, k + 2) = 2.0 * at(i, k + 1) - at(i, k) + change;
        }
      }
    }
  }
  return flight;
}

TEST(KernelFit, AKernelOfTheSplineSpaceIsRecoveredToRoundOff) {
  for (const int order : {1, 2}) {
    std::vector<Trajectories> flocks;
    for (std::uint64_t run = 1; run <= 4; ++run) {
      const KernelFlock flock{
          .order = order, .animals = 4, .frames = 30, .attraction = Straight, .alignment = {}};
      flocks.push_back(ExactFlight(order, FlyKernels(flock, run), Straight));
    }
    const KernelFit fit = Fit(Small(order), flocks);
    ASSERT_TRUE(fit.IsUsable());
    for (const KernelPoint& point : fit.kernels[0].points) {
      EXPECT_NEAR(point.value, Straight(point.distance), 1e-8) << order << " " << point.distance;
    }
    if (order == 1) continue;
    for (const KernelPoint& point : fit.kernels[1].points) {
      EXPECT_NEAR(point.value, 0, 1e-8) << point.distance;  // nobody aligns
    }
  }
}

TEST(KernelFit, FindsKernelsAndNoise) {
  const KernelFlock flock{.order = 2,
                          .animals = 8,
                          .frames = 80,
                          .attraction = Curved,
                          .alignment = [](double r) { return 0.4 * std::exp(-r / 2); },
                          .diffusion = 1e-3,
                          .noise = 2e-3};
  const KernelFit fit = Fit(Small(2), FlyRuns(flock, 8, 3));
  ASSERT_TRUE(fit.IsUsable());
  ASSERT_EQ(fit.kernels.size(), 2U);
  EXPECT_EQ(fit.kernels[0].name, "attraction");
  EXPECT_EQ(fit.kernels[1].name, "alignment");
  EXPECT_EQ(fit.dimensions, 3);
  EXPECT_NEAR(fit.position_noise, 2e-3, 2e-4);
  EXPECT_NEAR(fit.diffusion, 1e-3, 2e-4);
  for (const double r : {1.0, 1.5, 2.0}) {
    EXPECT_NEAR(fit.kernels[0].Value(r), Curved(r), 0.02) << r;
    EXPECT_NEAR(fit.kernels[1].Value(r), 0.4 * std::exp(-r / 2), 0.04) << r;
  }
}

// Velocities have felt the noise that drives them: taken as they come, with position noise besides,
// the alignment would come out as a third of what it is.
TEST(KernelFit, VelocityNoiseDoesNotHideAlignment) {
  const KernelFlock flock{.order = 2,
                          .animals = 8,
                          .frames = 80,
                          .attraction = [](double) { return 0.0; },
                          .alignment = [](double) { return 0.3; },
                          .diffusion = 5e-2,
                          .noise = 1e-2};
  double mean = 0, sd = 0;
  constexpr int kSeeds = 4;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const KernelFit fit = Fit(Small(2), FlyRuns(flock, 4, seed));
    ASSERT_TRUE(fit.IsUsable());
    mean += fit.kernels[1].Value(1.5) / kSeeds;
    sd += fit.kernels[1].Sd(1.5) / kSeeds;
  }
  EXPECT_NEAR(mean, 0.3, 3 * sd / std::sqrt(kSeeds));
  EXPECT_LT(sd, 0.05);
}

// Strong alignment forgets within the time that position noise makes the fit average over what
// process noise has done: with everything felt for ever it came out 7 % too strong near by.
// The oracle is the same flocks seen without position noise.
TEST(KernelFit, PositionNoiseDoesNotBiasAStrongAlignment) {
  KernelFlock flock{.order = 2,
                    .animals = 12,
                    .frames = 80,
                    .dt = 0.02,
                    .attraction = [](double) { return 0.05; },
                    .alignment = [](double) { return 0.4; },
                    .diffusion = 2e-3};
  double difference = 0, squares = 0, sd = 0;
  constexpr int kSeeds = 5;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    flock.noise = 0;
    const KernelFit clean = Fit({.order = 2, .intervals = 6}, FlyRuns(flock, 4, seed));
    flock.noise = 5e-3;
    const KernelFit noisy = Fit({.order = 2, .intervals = 6}, FlyRuns(flock, 4, seed));
    ASSERT_TRUE(clean.IsUsable() && noisy.IsUsable());
    EXPECT_NEAR(noisy.position_noise, 5e-3, 3e-4);
    const double d = noisy.kernels[1].Value(1.2) - clean.kernels[1].Value(1.2);
    difference += d / kSeeds;
    squares += d * d / kSeeds;
    sd += noisy.kernels[1].Sd(1.2) / kSeeds;
  }
  EXPECT_NEAR(difference, 0, 3 * std::sqrt(squares / kSeeds));
  EXPECT_NEAR(difference, 0, 0.02 * 0.4);
  EXPECT_LT(sd, 0.1 * 0.4);
}

// As many rows as are multiplied at once, and none left over.
TEST(KernelFit, TakesWholeBlocksOfRows) {
  const KernelFlock flock{.order = 1,
                          .animals = 4,
                          .dimensions = 1,
                          .frames = 8,
                          .attraction = Curved,
                          .alignment = {},
                          .noise = 1e-3};
  const KernelFit fit = Fit({.order = 1, .intervals = 60}, FlyRuns(flock, 64, 1));
  ASSERT_TRUE(fit.IsUsable());
  EXPECT_EQ(fit.rows, 64 * 4 * 7);
}

// Noise that drives is in the state that it is regressed on: with Stratonovich's integral a spring
// of order 1 would come out as 0 or nearly so, however long the data.
TEST(KernelFit, ProcessNoiseDoesNotHideASpring) {
  const KernelFlock flock{.order = 1,
                          .animals = 4,
                          .frames = 400,
                          .attraction = [](double) { return 0.2; },
                          .alignment = {},
                          .diffusion = 0.1};
  double mean = 0, sd = 0;
  constexpr int kSeeds = 4;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const KernelFit fit = Fit(Small(1), FlyRuns(flock, 4, seed));
    ASSERT_TRUE(fit.IsUsable());
    EXPECT_NEAR(fit.diffusion, 0.1, 0.01);
    mean += fit.kernels[0].Value(1) / kSeeds;
    sd += fit.kernels[0].Sd(1) / kSeeds;
  }
  EXPECT_NEAR(mean, 0.2, 3 * sd / std::sqrt(kSeeds));
  EXPECT_LT(sd, 0.05);
}

TEST(KernelFit, BandsCover) {
  const KernelFlock flock{.order = 1,
                          .animals = 5,
                          .dimensions = 2,
                          .frames = 40,
                          .attraction = Curved,
                          .alignment = {},
                          .noise = 2e-3};
  double covered = 0, known = 0, points = 0;
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    const KernelFit fit = Fit(Small(1), FlyRuns(flock, 10, seed));
    ASSERT_TRUE(fit.IsUsable());
    EXPECT_EQ(fit.dimensions, 2);
    EXPECT_NEAR(fit.position_noise, 2e-3, 2e-4);
    for (const KernelPoint& point : fit.kernels[0].points) {
      points += 1;
      if (!point.known) continue;
      known += 1;
      covered += std::abs(point.value - Curved(point.distance)) <= 1.96 * point.sd ? 1 : 0;
    }
  }
  EXPECT_GT(known, 0.5 * points);
  EXPECT_GT(covered, 0.88 * known);
  EXPECT_LT(covered, 0.999 * known);  // and are not wide for nothing
}

// Kernels that bend at first and hardly later: with the likeliest smoothness alone, which is near
// infinite there, the bands covered 80 and 68 % here.
TEST(KernelFit, BandsCoverAnAlignmentSeenWithNoise) {
  const auto align = [](double r) { return 0.4 * std::exp(-r / 1.5); };
  const KernelFlock flock{.order = 2,
                          .animals = 10,
                          .frames = 60,
                          .dt = 0.02,
                          .attraction = Curved,
                          .alignment = align,
                          .diffusion = 1e-3,
                          .noise = 2e-3};
  std::array<double, 2> covered{}, known{};
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const KernelFit fit = Fit({.order = 2, .intervals = 20}, FlyRuns(flock, 4, seed));
    ASSERT_TRUE(fit.IsUsable());
    for (std::size_t k = 0; k < 2; ++k) {
      for (const KernelPoint& point : fit.kernels[k].points) {
        if (!point.known) continue;
        const double truth = k == 0 ? Curved(point.distance) : align(point.distance);
        known[k] += point.density;
        if (std::abs(point.value - truth) <= 1.96 * point.sd) covered[k] += point.density;
      }
    }
  }
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_GT(known[k], 0);
    EXPECT_GT(covered[k], 0.86 * known[k]) << k;
  }
}

// What is left without noise is what the spline cannot follow: bands of noise alone covered 40 % of
// the pairs here.
TEST(KernelFit, BandsCoverWithoutNoise) {
  const auto tent = [](double r) { return 0.3 * std::max(0.0, 1 - std::abs(r - 1.03) / 0.4); };
  const KernelFlock flock{
      .order = 1, .animals = 5, .dimensions = 2, .frames = 40, .attraction = tent, .alignment = {}};
  double covered = 0, known = 0, pairs = 0, variance = 0, square = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const KernelFit fit =
        Fit({.order = 1, .intervals = 24, .reach = 2.5}, FlyRuns(flock, 10, seed));
    ASSERT_TRUE(fit.IsUsable());
    for (const KernelPoint& point : fit.kernels[0].points) {
      pairs += point.density;
      if (!point.known) continue;
      const double error = point.value - tent(point.distance);
      known += point.density;
      variance += point.density * point.sd * point.sd;
      square += point.density * error * error;
      if (std::abs(error) <= 1.96 * point.sd) covered += point.density;
    }
  }
  EXPECT_GT(known, 0.9 * pairs);
  EXPECT_GT(covered, 0.88 * known);
  EXPECT_LT(variance, 25 * square);  // and are not wide for nothing
}

// Flights attract more or less than each other: bands of noise alone were a fifth as wide as that
// makes the mean uncertain.
TEST(KernelFit, BandsAreWiderWhereFlightsDiffer) {
  constexpr int kFlights = 24;
  constexpr double kUnlike = 0.3;
  std::vector<Trajectories> flocks;
  for (std::uint64_t flight = 1; flight <= kFlights; ++flight) {
    Rng rng(flight, 5);
    const double strength = 1 + kUnlike * rng.Normal();
    const KernelFlock flock{.order = 1,
                            .animals = 4,
                            .frames = 30,
                            .attraction = [&](double r) { return strength * 0.4 * std::exp(-r); },
                            .alignment = {},
                            .noise = 1e-3};
    flocks.push_back(FlyKernels(flock, flight));
  }
  const KernelFit fit = Fit(Small(1), flocks);
  ASSERT_TRUE(fit.IsUsable());
  for (const double r : {1.0, 1.5, 2.0}) {
    const double scatter = kUnlike * 0.4 * std::exp(-r) / std::sqrt(kFlights);
    EXPECT_GT(fit.kernels[0].Sd(r), 0.6 * scatter) << r;
    EXPECT_LT(fit.kernels[0].Sd(r), 1.8 * scatter) << r;
  }
}

TEST(KernelFit, AddsMisfitToTheBandWhereThereIsAny) {
  FittedKernel kernel;
  kernel.basis = SplineBasis({0, 1, 2}, 0);
  kernel.coefficients = {1, 1};
  kernel.covariance = {9, 0, 0, 16};
  EXPECT_DOUBLE_EQ(kernel.Sd(0.5), 3);
  EXPECT_DOUBLE_EQ(kernel.Sd(1.5), 4);
  kernel.misfit = {4, 3};
  EXPECT_DOUBLE_EQ(kernel.Sd(0.5), 5);
  EXPECT_DOUBLE_EQ(kernel.Sd(1.5), 5);
}

TEST(KernelFit, IsTheSameFromElsewhereAndInAnyOrder) {
  const KernelFlock flock{.order = 2,
                          .animals = 5,
                          .frames = 40,
                          .attraction = Curved,
                          .alignment = [](double) { return 0.2; },
                          .diffusion = 1e-3};
  const std::vector<Trajectories> flocks = FlyRuns(flock, 4, 1);
  const KernelFit fit = Fit(Small(2), flocks);
  ASSERT_TRUE(fit.IsUsable());
  std::vector<Trajectories> turned(flocks.rbegin(), flocks.rend());
  for (Trajectories& run : turned) {
    std::reverse(run.trajectories.begin(), run.trajectories.end());
    for (Trajectory& trajectory : run.trajectories) {
      for (TrajectoryPoint& point : trajectory.points) {
        const Vec3d x = point.position;
        point.position = {5 - x.z, 0.6 * x.x + 0.8 * x.y, 2 + 0.8 * x.x - 0.6 * x.y};
        point.frame += 100;
      }
    }
  }
  const KernelFit again = Fit(Small(2), turned);
  for (std::size_t k = 0; k < 2; ++k) {
    for (const double r : {0.8, 1.5, 2.5}) {
      EXPECT_NEAR(again.kernels[k].Value(r), fit.kernels[k].Value(r), 0.02 * fit.kernels[k].Sd(r));
    }
  }
}

TEST(KernelFit, RunsOfOneFileAreRunsOfMany) {
  const KernelFlock flock{
      .order = 1, .animals = 4, .frames = 30, .attraction = Curved, .alignment = {}, .noise = 1e-3};
  const std::vector<Trajectories> flocks = FlyRuns(flock, 6, 1);
  std::vector<Trajectories> one(1);
  one[0].fps = flocks[0].fps;
  for (std::size_t run = 0; run < flocks.size(); ++run) {
    for (Trajectory trajectory : flocks[run].trajectories) {
      trajectory.id += static_cast<Id>(100 * run);
      for (TrajectoryPoint& point : trajectory.points) point.frame += static_cast<int>(30 * run);
      one[0].trajectories.push_back(trajectory);
    }
  }
  const KernelFit many = Fit(Small(1), flocks), single = Fit(Small(1), one);
  ASSERT_TRUE(single.IsUsable());
  EXPECT_EQ(many.kernels[0].coefficients, single.kernels[0].coefficients);
  EXPECT_EQ(many.rows, single.rows);
}

TEST(KernelFit, IsTheSameOnAnyNumberOfThreads) {
  const KernelFlock flock{.order = 2,
                          .animals = 5,
                          .frames = 40,
                          .attraction = Curved,
                          .alignment = [](double) { return 0.2; },
                          .diffusion = 1e-3,
                          .noise = 1e-3};
  const std::vector<Trajectories> flocks = FlyRuns(flock, 3, 1);
  const KernelFit one = Fit(Small(2), flocks, 1, 1), two = Fit(Small(2), flocks, 1, 2);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(one.kernels[k].coefficients, two.kernels[k].coefficients);
    EXPECT_EQ(one.kernels[k].covariance, two.kernels[k].covariance);
  }
}

TEST(KernelFit, FlagsDistancesWithoutPairs) {
  // Two clusters of two, far from each other: nobody is at the distances between.
  const KernelFlock flock{.order = 1,
                          .animals = 4,
                          .dimensions = 2,
                          .frames = 30,
                          .spread = 0.3,
                          .attraction = [](double r) { return r < 3 ? 0.3 : 0.001; },
                          .alignment = {},
                          .noise = 1e-3};
  std::vector<Trajectories> flocks;
  for (std::uint64_t run = 1; run <= 10; ++run) {
    KernelFlock pair = flock;
    pair.animals = 2;
    Trajectories both = FlyKernels(pair, run), other = FlyKernels(pair, 100 + run);
    for (Trajectory trajectory : other.trajectories) {
      trajectory.id += 2;
      for (TrajectoryPoint& point : trajectory.points) point.position.x += 10;
      both.trajectories.push_back(trajectory);
    }
    flocks.push_back(both);
  }
  const KernelFit fit = Fit(Small(1), flocks);
  ASSERT_TRUE(fit.IsUsable());
  int between = 0, near = 0;
  for (const KernelPoint& point : fit.kernels[0].points) {
    if (point.distance > 3 && point.distance < 7) {
      ++between;
      EXPECT_FALSE(point.known) << point.distance;
    }
    if (point.distance > 0.2 && point.distance < 0.6) near += point.known ? 1 : 0;
  }
  EXPECT_GT(between, 0);
  EXPECT_GT(near, 0);
}

// Of one kernel alone: a word when the other is there too, none when it is not.
TEST(KernelFit, NamesAKernelThatIsLeftOutAndActs) {
  KernelFlock flock;
  flock.order = 2;
  flock.frames = 80;
  flock.substeps = 10;
  flock.alignment = [](double r) { return 0.3 * std::exp(-r); };
  flock.diffusion = 1e-3;
  KernelFitOptions options = Small(2);
  options.kernels = {"alignment"};
  for (const bool attracts : {true, false}) {
    flock.attraction = [attracts](double r) { return attracts ? 0.4 * std::exp(-0.5 * r) : 0.0; };
    const KernelFit fit = Fit(options, {FlyKernels(flock, 1), FlyKernels(flock, 2)}, 20);
    ASSERT_TRUE(fit.IsUsable());
    EXPECT_EQ(fit.kernels.size(), 1U);
    EXPECT_EQ(fit.left_out.name, "attraction");
    const bool named = std::any_of(
        fit.warnings.begin(), fit.warnings.end(),
        [](const std::string& text) { return text.starts_with("attraction is left out"); });
    EXPECT_EQ(named, attracts) << fit.left_out.share;
  }
  EXPECT_TRUE(Fit(Small(2), {FlyKernels(flock, 1)}, 20).left_out.name.empty());
}

TEST(KernelFit, SaysWhyItCannot) {
  const KernelFlock flock{
      .order = 1, .animals = 3, .frames = 30, .attraction = Curved, .alignment = {}};
  const Trajectories flight = FlyKernels(flock, 1);
  EXPECT_EQ(FitKernels(Small(1), {}, 20, 1, 1).status, KernelFitStatus::kTooFewAnimals);
  EXPECT_EQ(FitKernels(Small(1), {Trajectories{}}, 20, 1, 1).status,
            KernelFitStatus::kTooFewAnimals);
  Trajectories alone = flight;
  alone.trajectories.resize(1);
  EXPECT_EQ(FitKernels(Small(1), {alone}, 20, 1, 1).status, KernelFitStatus::kTooFewAnimals);
  Trajectories brief = flight;
  for (Trajectory& trajectory : brief.trajectories) trajectory.points.resize(3);
  EXPECT_EQ(FitKernels(Small(1), {brief}, 20, 1, 1).status, KernelFitStatus::kTooFewFrames);
  KernelFitOptions many = Small(1);
  many.intervals = 400;
  EXPECT_EQ(FitKernels(many, {flight}, 20, 1, 1).status, KernelFitStatus::kTooFewRows);
  EXPECT_THROW(FitKernels(Small(3), {flight}, 20, 1, 1), std::invalid_argument);
  EXPECT_THROW(FitKernels(Small(1), {flight}, 0, 1, 1), std::invalid_argument);
  EXPECT_FALSE(StatusText(KernelFitStatus::kTooFewRows).empty());
}

TEST(KernelFit, LeavesOutWhatIsOutOfReach) {
  const KernelFlock flock{.order = 1,
                          .animals = 6,
                          .frames = 40,
                          .attraction = [](double r) { return r < 1.5 ? 0.3 : 0.0; },
                          .alignment = {},
                          .noise = 1e-3};
  KernelFitOptions options = Small(1);
  options.reach = 1.5;
  const KernelFit fit = Fit(options, FlyRuns(flock, 8, 1));
  ASSERT_TRUE(fit.IsUsable());
  EXPECT_LE(fit.kernels[0].basis.high(), 1.5);
  EXPECT_NEAR(fit.kernels[0].Value(1), 0.3, 0.02);
}

}  // namespace
}  // namespace flocklift
