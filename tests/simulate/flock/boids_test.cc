// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/boids.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "simulate/core/rigid3.h"
#include "simulate/fields/curl_noise.h"
#include "tests/simulate/flock/flocks.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

std::vector<Vec3d> Accelerations(const NamedFlock& flock, const BoidsParameters<double>& p) {
  World world;
  world.dt = 1e-6;
  ReferenceEngine engine(world, {AsSwarm(flock, p)}, {});
  engine.Step();
  return engine.Accelerations();
}

// From a script that knows the formulas and nothing of this code (pixels and steps).
TEST(Boids, GoldenTable) {
  const NamedFlock flock{"golden",
                         {{0, 0, 0}, {10, 5, -3}, {60, -40, 25}, {-120, 80, 10}, {400, 0, 0}},
                         {{6, 0, 1}, {5, 4, -2}, {-3, 7, 0}, {0, -8, 2}, {9, 1, 1}}};
  const std::vector<Vec3d> golden = {{-0.376666666666667, -0.055, 0.0406666666666667},
                                     {0.115, 0.06, 0.0305},
                                     {0.2, -0.1075, -0.0415},
                                     {0.3, 0.16, -0.04},
                                     {0, 0, 0}};
  BoidsParameters<double> p = PlainRules(30, 150);
  p.alpha_s = 0.02;
  p.alpha_c = 0.001;
  p.alpha_a = 0.03;
  const std::vector<Vec3d> actual = Accelerations(flock, p);
  for (std::size_t k = 0; k < golden.size(); ++k) {
    EXPECT_LT(Norm(actual[k] - golden[k]), 1e-12) << k;
  }
}

// The formulas of equations.md once more, over all pairs.
std::vector<Vec3d> BruteForce(const NamedFlock& flock, const BoidsParameters<double>& p) {
  const std::size_t n = flock.position.size();
  std::vector<Vec3d> result(n);
  for (std::size_t j = 0; j < n; ++j) {
    Vec3d separation, position, velocity;
    double near = 0, seen = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (i == j) continue;
      const double distance = Norm(flock.position[i] - flock.position[j]);
      if (distance < p.d_s) {
        separation += flock.position[j] - flock.position[i];
        ++near;
      }
      if (distance < p.d_v) {
        position += flock.position[i];
        velocity += flock.velocity[i];
        ++seen;
      }
    }
    if (near > 0) result[j] += p.alpha_s / near * separation;
    if (seen > 0) {
      result[j] += p.alpha_c * (position / seen - flock.position[j]) +
                   p.alpha_a * (velocity / seen - flock.velocity[j]);
    }
  }
  return result;
}

TEST(Boids, EqualsBruteForceOnEveryFlock) {
  for (const NamedFlock& flock : ManyFlocks()) {
    SCOPED_TRACE(flock.name);
    for (const BoidsParameters<double>& p : {PlainRules(0.4, 1.05), PlainRules(2.1, 0.7)}) {
      const std::vector<Vec3d> actual = Accelerations(flock, p);
      const std::vector<Vec3d> expected = BruteForce(flock, p);
      for (std::size_t k = 0; k < expected.size(); ++k) {
        EXPECT_LT(Norm(actual[k] - expected[k]), 1e-9) << k;
      }
    }
  }
}

TEST(Boids, TurnsMovesAndRenumbersWithTheWorld) {
  const BoidsParameters<double> p = PlainRules(0.5, 1.2, 0.3);
  NamedFlock flock = RandomFlock("", 300, {4, 4, 4}, 21);
  const std::vector<Vec3d> before = Accelerations(flock, p);
  const double angle = 0.7;
  const Rotation3d turn =
      RotationFromQuaternion({std::cos(angle), 0.6 * std::sin(angle), 0.8 * std::sin(angle), 0});
  for (Vec3d& x : flock.position) x = turn * x + Vec3d{7, -30, 12};
  for (Vec3d& v : flock.velocity) v = turn * v + Vec3d{3, 1, -2};  // only differences count
  std::reverse(flock.position.begin(), flock.position.end());
  std::reverse(flock.velocity.begin(), flock.velocity.end());
  const std::vector<Vec3d> after = Accelerations(flock, p);
  for (std::size_t k = 0; k < before.size(); ++k) {
    EXPECT_LT(Norm(after[before.size() - 1 - k] - turn * before[k]), 1e-9);
  }
}

// Where everybody sees everybody, the means are symmetric and the momentum stays.
TEST(Boids, MomentumStaysWhereEverybodySeesEverybody) {
  const NamedFlock flock = RandomFlock("", 50, {1, 1, 1}, 4);
  Vec3d sum;
  for (const Vec3d& a : Accelerations(flock, PlainRules(5, 5))) sum += a;
  EXPECT_LT(Norm(sum), 1e-10);
}

TEST(Boids, PairWithinTheSeparationRadiusMovesApart) {
  NamedFlock flock{"pair", {{0, 0, 0}, {0.3, 0, 0}}, {{}, {}}};
  BoidsParameters<double> p = PlainRules(1, 1);
  p.alpha_c = 0;
  World world;
  world.dt = 0.05;
  Engine engine(world, {AsSwarm(flock, p)}, {});
  for (int step = 0; step < 40; ++step) engine.Step();
  const FlockState state = engine.State();
  EXPECT_GT(Norm(state.position[1] - state.position[0]), 0.9);
}

TEST(Boids, TimeUnitsAreOnlyUnits) {
  // The assignment's numbers in steps, and by hand in seconds at 30 steps/s.
  const BoidsParameters<double> p = InSeconds(AssignmentParameters());
  EXPECT_DOUBLE_EQ(p.s_max, 300);
  EXPECT_DOUBLE_EQ(p.s_min, 150);
  EXPECT_DOUBLE_EQ(p.alpha_s, 18);
  EXPECT_DOUBLE_EQ(p.alpha_c, 0.9);
  EXPECT_DOUBLE_EQ(p.alpha_a, 0.9);
  EXPECT_DOUBLE_EQ(p.alpha_b, 450);
  EXPECT_DOUBLE_EQ(p.d_v, 150);
  EXPECT_DOUBLE_EQ(p.time_unit, 1);
}

// All of a bird's acceleration, differentiated through the terms: in are the parameters alpha_s,
// alpha_c, alpha_a, d_s, d_v, taper, alpha_b, wall_taper, cruise, level, then x and v of the bird
// and of two neighbours.
struct Acceleration {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    BoidsParameters<T> p;
    p.alpha_s = in[0];
    p.alpha_c = in[1];
    p.alpha_a = in[2];
    p.d_s = in[3];
    p.d_v = in[4];
    p.taper = in[5];
    p.alpha_b = in[6];
    p.wall_taper = in[7];
    p.cruise = in[8];
    p.level = in[9];
    const Vec3<T> x{in[10], in[11], in[12]}, v{in[13], in[14], in[15]};
    const auto pairs = MakeBoidsPairs<T>(p, p.taper);
    typename BoidsPairs<T>::Sums sums;
    for (const T* n = in + 16; n != in + 28; n += 6) {
      sums += pairs.Pair(Vec3<T>{n[0], n[1], n[2]} - x, Vec3<T>{n[3], n[4], n[5]} - v);
    }
    const Vec3<T> low{T(-5.0), T(-5.0), T(-5.0)}, high{T(5.0), T(5.0), T(5.0)};
    return pairs.Finish(sums) + MakeBoidsSelf(p, low, high, T(10.0)).At(x, v);
  }
};

TEST(Boids, Gradient) {
  // Neighbours on the edges of both windows, the wall's push half on.
  const std::array<double, 10> parameters = {1.5, 0.3, 0.8, 2.0, 4.0, 1.0, 6.0, 4.0, 0.5, 0.3};
  for (const double shift : {-0.05, 0.05}) {
    std::array<double, 28> in = {0,   0,   0,    0,   0,   0,   0, 0, 0, 0,  //
                                 4.2, 1.0, -5.5, 6.0, 7.0, 1.0,              //
                                 5.8, 1.5, -5.0, 7.0, 6.0, 0.5,              //
                                 7.2, 2.5, -7.2, 4.0, 9.0, -1.0};
    std::copy(parameters.begin(), parameters.end(), in.begin());
    in[16] += shift;
    in[22] += shift;
    ExpectGradientMatches(Acceleration{}, in);
  }
}

TEST(Boids, NoiseIsOfItsKind) {
  // One animal without rules moves by the noise alone.
  const NamedFlock one{"", {{2.3, 0.4, -1.7}}, {{0, 0, 0}}};
  const auto velocity = [&one](NoiseKind kind) {
    BoidsParameters<double> p = PlainRules(1, 1);
    p.noise = 2;
    p.noise_scale = 3;
    p.noise_kind.index = static_cast<int>(kind);
    World world;
    world.dt = 0.5;
    ReferenceEngine engine(world, {AsSwarm(one, p)}, {});
    engine.Step();
    return engine.State().velocity[0];
  };
  const NoiseTerm<double> field{6, 3, 1};  // of the world's default seed
  EXPECT_EQ(velocity(NoiseKind::kNone), Vec3d{});
  EXPECT_LT(Norm(velocity(NoiseKind::kCurl) - 0.5 * CurlNoise(field, one.position[0])), 1e-9);
  EXPECT_LT(Norm(velocity(NoiseKind::kPerlin) - 0.5 * PerlinVelocity(field, one.position[0])),
            1e-9);
  EXPECT_GT(Norm(velocity(NoiseKind::kWhite)), 0.01);
  EXPECT_GT(Norm(velocity(NoiseKind::kCurl)), 0.01);
}

}  // namespace
}  // namespace flocklift
