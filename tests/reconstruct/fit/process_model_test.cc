// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/process_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulate/core/check.h"
#include "simulate/core/rng.h"

namespace flocklift {
namespace {

const Region kBox{{-4, -4, -4}, {4, 4, 4}};

ModelSpec Boids() {
  ModelSpec model;
  model.name = "boids";
  model.parameters = {{"d_s", 2},        {"d_v", 5},           {"taper", 1},
                      {"wall_taper", 2}, {"cruise", 0},        {"noise_time", 0},
                      {"blind", 1},      {"blind_taper", 0.4}, {"level", 0.3}};
  return model;
}

struct Flock {
  std::vector<Vec3d> x, v;
};
Flock RandomFlock(std::uint64_t seed) {
  Rng rng(seed);
  const auto normal = [&rng] { return Vec3d{rng.Normal(), rng.Normal(), rng.Normal()}; };
  Flock flock;
  for (int i = 0; i < 12; ++i) {
    flock.x.push_back(2.5 * normal());
    flock.v.push_back(4.0 * normal());
  }
  return flock;
}

double& Component(std::vector<Vec3d>* values, std::size_t i, int axis) {
  Vec3d& value = (*values)[i];
  return axis == 0 ? value.x : axis == 1 ? value.y : value.z;
}

TEST(ProcessModel, OwnSlopesAreNumericDifferences) {
  const ProcessModel model = MakeProcessModel(Boids(), {}, kBox);
  Flock flock = RandomFlock(4);
  const std::size_t n = flock.x.size();
  std::vector<Vec3d> a(n), low(n), high(n);
  std::vector<OwnSlope> slopes(n);
  model.evaluate({}, flock.x, flock.v, a, slopes);
  const double half = 1e-6;
  for (std::size_t i = 0; i < n; ++i) {
    for (int axis = 0; axis < 6; ++axis) {
      double& value = Component(axis < 3 ? &flock.x : &flock.v, i, axis % 3);
      const double before = value;
      value = before - half;
      model.evaluate({}, flock.x, flock.v, low, {});
      value = before + half;
      model.evaluate({}, flock.x, flock.v, high, {});
      value = before;
      const Vec3d slope = (high[i] - low[i]) / (2 * half);
      const auto& own = axis < 3 ? slopes[i].position : slopes[i].velocity;
      const auto column = static_cast<std::size_t>(axis % 3);
      EXPECT_NEAR(own[column], slope.x, 1e-6 * (1 + Norm(slope)));
      EXPECT_NEAR(own[3 + column], slope.y, 1e-6 * (1 + Norm(slope)));
      EXPECT_NEAR(own[6 + column], slope.z, 1e-6 * (1 + Norm(slope)));
    }
  }
}

TEST(ProcessModel, SlopesCostTheAccelerationsNothing) {
  const ProcessModel model = MakeProcessModel(Boids(), {}, kBox);
  const Flock flock = RandomFlock(5);
  std::vector<Vec3d> with(flock.x.size()), without(flock.x.size());
  std::vector<OwnSlope> slopes(flock.x.size());
  model.evaluate({}, flock.x, flock.v, with, slopes);
  model.evaluate({}, flock.x, flock.v, without, {});
  for (std::size_t i = 0; i < with.size(); ++i) EXPECT_LT(Norm(with[i] - without[i]), 1e-12);
}

TEST(ProcessModel, ThetaReplacesWhatTheModelSays) {
  ModelSpec other = Boids();
  other.parameters["d_s"] = 3;
  other.parameters["alpha_a"] = 0.2;
  const Flock flock = RandomFlock(6);
  std::vector<Vec3d> by_theta(flock.x.size()), by_model(flock.x.size());
  const ProcessModel freed = MakeProcessModel(Boids(), {"alpha_a", "d_s", "s_max"}, kBox);
  EXPECT_EQ(freed.start[1], 2);
  freed.evaluate(std::vector<double>{0.2, 3, 9}, flock.x, flock.v, by_theta, {});
  MakeProcessModel(other, {}, kBox).evaluate({}, flock.x, flock.v, by_model, {});
  EXPECT_EQ(by_theta, by_model);
  EXPECT_EQ(freed.speed_range(std::vector<double>{0.2, 3, 9}).high, 9);
  EXPECT_EQ(freed.speed_range(std::vector<double>{0.2, 3, 9}).low, 6);
}

TEST(ProcessModel, HardEdgesAndMemoryAreNotSmooth) {
  EXPECT_FALSE(SmoothParameters(Boids()).empty());
  for (const auto& [name, value] : std::map<std::string, double>{{"taper", 0},
                                                                 {"wall_taper", 0},
                                                                 {"cruise", 1},
                                                                 {"noise_time", 0.5},
                                                                 {"nearest", 6},
                                                                 {"blind_taper", 0}}) {
    ModelSpec model = Boids();
    model.parameters[name] = value;
    EXPECT_TRUE(SmoothParameters(model).empty()) << name;
    EXPECT_THROW(MakeProcessModel(model, {}), InputError) << name;
  }
  EXPECT_THROW(MakeProcessModel(Boids(), {"cruise"}), InputError);
}

}  // namespace
}  // namespace flocklift
