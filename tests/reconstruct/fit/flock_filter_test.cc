// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/flock_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "simulate/core/check.h"
#include "tests/reconstruct/fit/flocks.h"
#include "tests/reconstruct/fit/linear_flock.h"

namespace flocklift {
namespace {

ProcessModel Linear() {
  ModelSpec model;
  model.name = "linear";
  return MakeProcessModel(model, {"cohesion", "alignment"});
}

FilterSweep Sweep(const Trajectories& seen, const FlockNoise& noise,
                  const FilterOptions& options = {}, std::vector<double> theta = {0.05, 0.2}) {
  return RunFilter(options, Linear(), theta, noise,
                   FilterInput(ObservedFlock(seen, seen.fps.value(), 5)));
}

TEST(FlockFilter, UsesTheMemoryThatItIsGiven) {
  const Trajectories seen = FlyLinearFlock(4, 30, 5).seen;
  const FilterInput input(ObservedFlock(seen, seen.fps.value(), 5));
  const auto sweep = [&](double cohesion, FilterSweep memory) {
    return RunFilter({}, Linear(), {cohesion, 0.2}, {.diffusion = 4e-3}, input, std::move(memory));
  };
  FilterSweep other = sweep(0.3, {});
  const Innovation* const memory = other.innovations.data();
  const FilterSweep again = sweep(0.05, std::move(other)), fresh = sweep(0.05, {});
  EXPECT_EQ(again.innovations.data(), memory);
  EXPECT_EQ(again.cost, fresh.cost);
  ASSERT_EQ(again.innovations.size(), fresh.innovations.size());
  for (std::size_t k = 0; k < fresh.innovations.size(); ++k) {
    EXPECT_EQ(again.innovations[k].value, fresh.innovations[k].value);
    EXPECT_EQ(again.innovations[k].covariance, fresh.innovations[k].covariance);
  }
}

// One animal alone has no forces: positions are integrated noise, whose joint covariance is known.
// The filter's likelihood of frames 3.. given the first two must be that of the dense Gaussian,
// but for its start: as diffuse as the data's own spread.
TEST(FlockFilter, OneAnimalsLikelihoodIsThatOfTheJointGaussian) {
  const int frames = 12;
  const Trajectories seen = WithNoise(FlyLinearFlock(4, frames, 1).seen, 2e-4, 6);
  const FlockNoise noise{.diffusion = 4e-3, .position_variance = 5e-8};
  const FilterInput input(ObservedFlock(seen, seen.fps.value(), 5));
  const FilterSweep sweep = RunFilter({}, Linear(), {0.05, 0.2}, noise, input);
  ASSERT_EQ(sweep.innovations.size(), frames - 2U);

  // x_k and the noise that the engine's steps add up to, from frame 2 on.
  const double dt = LinearFlock::kDt, h = dt / 4, q = 2 * noise.diffusion;
  const double floor = 1e-6 * q * dt * dt * dt, r = noise.position_variance + floor;
  const Eigen::Index n = frames - 2;
  Eigen::Matrix2d start;
  const double v_start = 2 * r / (dt * dt) + q * dt / 3 + input.second_differences()[0] / (dt * dt);
  start << r, r / dt, r / dt, v_start;
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = 0; b < n; ++b) {
      const double ta = dt * static_cast<double>(a + 1), tb = dt * static_cast<double>(b + 1);
      const Eigen::Vector2d ga(1, ta), gb(1, tb);
      double sum = ga.dot(start * gb) + (a == b ? r : 0);
      for (int step = 0; step < 4 * (std::min(a, b) + 1); ++step) {
        // A kick at step s of h moves x at time t by t - s h, this step's move included.
        sum += q * h * (ta - step * h) * (tb - step * h);
      }
      covariance(a, b) = sum;
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
  const auto& points = seen.trajectories[0].points;
  double cost = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = [&](std::size_t k) {
      const Vec3d& x = points[k].position;
      return axis == 0 ? x.x : axis == 1 ? x.y : x.z;
    };
    Eigen::VectorXd deviation(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const double t = static_cast<double>(k + 1);
      deviation[k] = at(static_cast<std::size_t>(k) + 2) - (at(1) + t * (at(1) - at(0)));
    }
    cost += deviation.dot(llt.solve(deviation));
    for (Eigen::Index k = 0; k < n; ++k) cost += 2 * std::log(llt.matrixL()(k, k));
  }
  EXPECT_NEAR(sweep.cost, cost, 1e-7 * std::abs(cost));
}

TEST(FlockFilter, WhitenedInnovationsAreWhite) {
  const Trajectories seen = WithNoise(FlyLinearFlock(9, 800).seen, 3e-4, 2);
  const FilterSweep sweep =
      Sweep(seen, {.diffusion = LinearFlock::kDiffusion, .position_variance = 9e-8});
  double squares = 0, products = 0, count = 0;
  std::array<double, 3> last{};
  for (const Innovation& i : sweep.innovations) {
    if (i.animal != 4) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double white = i.value[axis] / std::sqrt(i.covariance[0]);
      squares += white * white;
      products += white * last[axis];
      count += 1;
      last[axis] = white;
    }
  }
  EXPECT_NEAR(squares / count, 1, 4 * std::sqrt(2 / count));
  EXPECT_NEAR(products / count, 0, 4 / std::sqrt(count));
}

// A gain that was kept once it settled is the gain that would have been computed.
TEST(FlockFilter, ASettledGainCostsNothing) {
  Trajectories seen = WithNoise(FlyLinearFlock(3, 400, 5).seen, 1e-4, 2);
  const FlockNoise noise{.diffusion = 5e-3, .position_variance = 1e-8};
  const FilterSweep sweep = Sweep(seen, noise);
  // A gap late in the run of one animal; the others' innovations before it stay as they are.
  std::erase_if(seen.trajectories[0].points,
                [](const TrajectoryPoint& p) { return p.frame > 300 && p.frame < 304; });
  const FilterSweep holed = Sweep(seen, noise);
  double before = 0, after = 0;
  for (const Innovation& i : holed.innovations) {
    if (i.animal != 0) continue;
    if (i.frame == 300) before = i.covariance[0];
    if (i.frame == 304) after = i.covariance[0];
  }
  EXPECT_GT(after, 4 * before);  // it was predicted over four frames
  EXPECT_NEAR(holed.innovations.back().covariance[0], sweep.innovations.back().covariance[0],
              1e-9 * before);
}

// Two animals on a line, 3 m to either side of their mean, who fly 2 m/s.
TEST(FilterInput, KnowsWhatSinglePrecisionRounds) {
  Trajectories seen;
  for (const double side : {-3.0, 3.0}) {
    Trajectory& trajectory = seen.trajectories.emplace_back();
    trajectory.id = side > 0 ? 1 : 2;
    for (int frame = 1; frame <= 11; ++frame) {
      TrajectoryPoint& point = trajectory.points.emplace_back();
      point.frame = frame;
      point.position = {0, 1000 + side, 0.2 * frame};
    }
  }
  const Rounding rounding = FilterInput(ObservedFlock(seen, 10, 5)).rounding();
  const double half = std::pow(2.0, -24);  // of neighbouring floats' distance, at 1
  EXPECT_NEAR(rounding.velocity, half * half * 4 / 3, 1e-9 * half * half);
  EXPECT_NEAR(rounding.position, half * half * (9 + 0.04 * 10) / 3, 1e-9 * half * half);
}

TEST(FlockFilter, RoundingIsLeftWithoutNoise) {
  const FilterInput input(ObservedFlock(FlyLinearFlock(4, 40, 5).seen, 1 / LinearFlock::kDt, 5));
  const FilterSweep sweep = RunFilter({}, Linear(), {0.05, 0.2}, {.diffusion = 1e-30}, input);
  const double settled = sweep.innovations.back().covariance[0];
  EXPECT_GT(settled, 4 * input.rounding().position);  // one of every step
  EXPECT_LT(settled, 40 * input.rounding().position);
}

// Without noise all is foreseen from the second frame on, but for how an acceleration changes:
// the velocity of that frame is not the one between the two.
TEST(FlockFilter, WhoEntersHasBeenAccelerated) {
  constexpr int kSteps = 4;
  constexpr double kDt = 1.0 / 30, kStep = kDt / kSteps, kCohesion = 0.1, kAlignment = 0.3;
  std::vector<Vec3d> x = {{0, 0, 0}, {3, 1, 0}, {-1, 2, 1}, {0, -2, 2}};
  std::vector<Vec3d> v = {{2, 0, 0}, {0, -1, 1}, {1, 1, 0}, {-1, 0, 2}};
  Trajectories seen;
  seen.fps = 1 / kDt;
  for (std::size_t i = 0; i < x.size(); ++i) {
    seen.trajectories.push_back({.id = static_cast<Id>(i) + 1, .points = {}});
  }
  for (int frame = 1; frame <= 4; ++frame) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      TrajectoryPoint& point = seen.trajectories[i].points.emplace_back();
      point.frame = frame;
      point.position = x[i];
    }
    for (int step = 0; step < kSteps; ++step) {
      std::vector<Vec3d> a(x.size());
      for (std::size_t i = 0; i < x.size(); ++i) {
        for (std::size_t j = 0; j < x.size(); ++j) {
          a[i] += kCohesion * (x[j] - x[i]) + kAlignment * (v[j] - v[i]);
        }
      }
      for (std::size_t i = 0; i < x.size(); ++i) {
        v[i] += kStep * a[i];
        x[i] += kStep * v[i];
      }
    }
  }
  const FilterSweep sweep = Sweep(seen, {.diffusion = 1e-6}, {.substeps = kSteps}, {0.1, 0.3});
  ASSERT_EQ(sweep.innovations.size(), 2 * x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto& points = seen.trajectories[i].points;
    const Vec3d bend = points[2].position - 2.0 * points[1].position + points[0].position;
    const auto& e = sweep.innovations[i].value;
    // 3/8 of the bend with the velocity between the frames.
    EXPECT_LT(Norm(Vec3d{e[0], e[1], e[2]}), 0.03 * Norm(bend)) << i;
  }
}

TEST(FlockFilter, TurningTheWorldChangesNothing) {
  Trajectories seen = FlyLinearFlock(3, 60, 4).seen;
  const FlockNoise noise{.diffusion = 5e-3, .position_variance = 1e-8};
  for (const int substeps : {4, 0}) {
    const double cost = Sweep(seen, noise, {.substeps = substeps, .bridged_gap = 5}).cost;
    Trajectories turned = seen;
    for (Trajectory& t : turned.trajectories) {
      for (TrajectoryPoint& p : t.points) {
        p.position = {p.position.y + 3, -p.position.x, p.position.z};
      }
    }
    EXPECT_NEAR(Sweep(turned, noise, {.substeps = substeps, .bridged_gap = 5}).cost, cost,
                1e-9 * std::abs(cost));
  }
}

TEST(FlockFilter, TheTruthIsLikelierThanItsNeighbours) {
  const Trajectories seen = FlyLinearFlock(6).seen;
  const FlockNoise noise{.diffusion = LinearFlock::kDiffusion, .position_variance = 0};
  const double truth = Sweep(seen, noise).cost;
  EXPECT_LT(truth, Sweep(seen, noise, {}, {0.07, 0.2}).cost);
  EXPECT_LT(truth, Sweep(seen, noise, {}, {0.05, 0.25}).cost);
  EXPECT_LT(truth, Sweep(seen, noise, {}, {0.05, 0.15}).cost);
  EXPECT_LT(truth, Sweep(seen, {.diffusion = 6e-3, .position_variance = 0}).cost);
  // ... in the engine's own steps.
  EXPECT_LT(truth, Sweep(seen, noise, {.substeps = 0, .bridged_gap = 5}).cost);
  EXPECT_THROW(Sweep(seen, {}), std::invalid_argument);
}

// One animal on a line: pushed back until it is at the origin, and on afterwards, without slopes.
struct Braking {
  Trajectories seen;
  ProcessModel model;
  int held_from = 0, free_from = 0;  // first frame at the lowest speed, first away from it again
};

Braking FlyBraking(std::uint64_t seed) {
  constexpr double kLow = 1, kPush = 2, kStep = 1.0 / 120, kNoise = 0.05;
  Braking flown;
  flown.model.evaluate = [](std::span<const double>, std::span<const Vec3d> x,
                            std::span<const Vec3d>, std::span<Vec3d> a, std::span<OwnSlope> slope) {
    for (std::size_t i = 0; i < x.size(); ++i) a[i] = {x[i].x < 0 ? -kPush : kPush, 0, 0};
    std::fill(slope.begin(), slope.end(), OwnSlope{});
  };
  flown.model.speed_range = [](std::span<const double>) {
    return SpeedRange{.low = kLow, .high = 100};
  };
  Rng rng(seed);
  Vec3d x{-2.5, 0, 0}, v{2, 0, 0};
  Trajectory trajectory;
  for (int frame = 1; frame <= 100; ++frame) {
    TrajectoryPoint point;
    point.frame = frame;
    point.position = x;
    trajectory.points.push_back(point);
    for (int step = 0; step < 4; ++step) {
      const double noise = std::sqrt(kStep) * kNoise;
      v += Vec3d{kStep * (x.x < 0 ? -kPush : kPush), 0, 0} +
           noise * Vec3d{rng.Normal(), rng.Normal(), rng.Normal()};
      if (Norm(v) < kLow) v = kLow / Norm(v) * v;
      x += kStep * v;
    }
    if (flown.held_from == 0 && Norm(v) < kLow + 1e-9) flown.held_from = frame + 1;
    if (flown.held_from > 0 && flown.free_from == 0 && Norm(v) > 1.2 * kLow) {
      flown.free_from = frame + 1;
    }
  }
  flown.seen.fps = 30;
  flown.seen.trajectories = {trajectory};
  return flown;
}

// The gain of an animal at its speed limit is that of its frame: away from the limit it is soon
// what it would be without one, though the slopes are the same in every frame.
TEST(FlockFilter, ALimitIsForgottenAfterItsFrame) {
  Braking flown = FlyBraking(3);
  ASSERT_GT(flown.held_from, 5);
  ASSERT_GT(flown.free_from, flown.held_from + 10);
  ASSERT_LT(flown.free_from, 80);
  const FilterInput input(ObservedFlock(flown.seen, 30, 5));
  const FlockNoise noise{.diffusion = 0.5 * 0.05 * 0.05, .position_variance = 0};
  const FilterSweep sweep = RunFilter({}, flown.model, {}, noise, input);
  flown.model.speed_range = nullptr;
  const FilterSweep without = RunFilter({}, flown.model, {}, noise, input);
  ASSERT_EQ(sweep.innovations.size(), without.innovations.size());
  for (std::size_t k = 0; k < sweep.innovations.size(); ++k) {
    const Innovation& innovation = sweep.innovations[k];
    const double along = innovation.covariance[0], across = innovation.covariance[3];
    const double free = without.innovations[k].covariance[0];
    if (innovation.frame > flown.free_from + 15 || innovation.frame < flown.held_from - 5) {
      EXPECT_NEAR(along, free, 1e-5 * free) << innovation.frame;
      EXPECT_FALSE(innovation.is_limited) << innovation.frame;
    } else if (innovation.frame > flown.held_from + 3 && innovation.frame < flown.held_from + 8) {
      EXPECT_LT(along, 0.5 * free) << innovation.frame;
      EXPECT_NEAR(across, free, 0.3 * free) << innovation.frame;
      EXPECT_TRUE(innovation.is_limited) << innovation.frame;
    }
  }
}

// At the limit, and where it is reached and left, innovations along the way have mean 0.
TEST(FlockFilter, ASpeedLimitLeavesInnovationsWithoutBias) {
  double sum = 0, squares = 0, count = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Braking flown = FlyBraking(seed);
    const FilterInput input(ObservedFlock(flown.seen, 30, 5));
    const FilterSweep sweep = RunFilter(
        {}, flown.model, {}, {.diffusion = 0.5 * 0.05 * 0.05, .position_variance = 0}, input);
    for (const Innovation& innovation : sweep.innovations) {
      if (innovation.frame < flown.held_from - 5 || !innovation.is_limited) continue;
      const double white = innovation.value[0] / std::sqrt(innovation.covariance[0]);
      sum += white;
      squares += white * white;
      count += 1;
    }
  }
  EXPECT_LT(std::abs(sum), 3.5 * std::sqrt(squares));
  EXPECT_LT(squares / count, 1.2);
}

TEST(ProcessModel, ItsSlopesAreThoseOfItsAccelerations) {
  const ProcessModel model = Linear();
  const std::vector<double> theta{0.3, 0.7};
  std::vector<Vec3d> x{{1, 2, 3}, {-1, 0.5, 2}, {0.2, 0.1, -3}}, v{{1, 0, 1}, {0, 2, 0}, {3, 1, 1}};
  std::vector<Vec3d> a(3), moved(3);
  std::vector<OwnSlope> slopes(3);
  model.evaluate(theta, x, v, a, slopes);
  // By hand: springs to the two others.
  EXPECT_NEAR(a[0].x, 0.3 * (-2 - 0.8) + 0.7 * (-1 + 2), 1e-12);
  x[1].y += 1e-3;
  v[1].z += 2e-3;
  model.evaluate(theta, x, v, moved, {});
  EXPECT_NEAR((moved[1].y - a[1].y) / 1e-3, slopes[1].position[4], 1e-9);
  EXPECT_NEAR((moved[1].z - a[1].z) / 2e-3, slopes[1].velocity[8], 1e-9);
  ModelSpec lin;
  lin.name = "lin";
  EXPECT_TRUE(SmoothParameters(lin).empty());
  EXPECT_THROW(MakeProcessModel(lin, {}), InputError);
  lin.name = "linear";
  EXPECT_THROW(MakeProcessModel(lin, {"cohesio"}), InputError);
}

}  // namespace
}  // namespace flocklift
