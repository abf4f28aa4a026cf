// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/curl_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulate/core/rng.h"
#include "simulate/flock/kernels/lattice_pack.h"
#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

constexpr std::uint32_t kSeed = 12345;

// Of (x, y, z, gain, scale).
struct Velocity {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    return CurlNoise(NoiseTerm<T>{in[3], in[4], kSeed}, Vec3<T>{in[0], in[1], in[2]});
  }
};
struct Potential {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    return NoisePotential(NoiseTerm<T>{in[3], in[4], kSeed}, Vec3<T>{in[0], in[1], in[2]}).value;
  }
};
struct RawPerlin {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    return PerlinVelocity(NoiseTerm<T>{in[3], in[4], kSeed}, Vec3<T>{in[0], in[1], in[2]});
  }
};

Vec3d RandomPoint(Rng* rng, double size = 20) {
  return {rng->Uniform(-size, size), rng->Uniform(-size, size), rng->Uniform(-size, size)};
}

using Dual3 = ceres::Jet<double, 3>;
Vec3<Dual3> AsDual(const Vec3d& x) { return {Dual3(x.x, 0), Dual3(x.y, 1), Dual3(x.z, 2)}; }
double Divergence(const Vec3<Dual3>& v) { return v.x.v[0] + v.y.v[1] + v.z.v[2]; }
double Steepness(const Vec3<Dual3>& v) { return v.x.v.norm() + v.y.v.norm() + v.z.v.norm(); }

TEST(CurlNoise, IsTheCurlOfItsPotential) {
  Rng rng(1);
  const double gain = 0.25, scale = 0.4, h = 1e-6;
  for (int k = 0; k < 50; ++k) {
    const Vec3d x = RandomPoint(&rng);
    const auto slope = [&](const Vec3d& axis) {
      const auto at = [&](const Vec3d& p) {
        return Evaluate<double>(Potential{}, std::array{p.x, p.y, p.z, gain, scale});
      };
      return (at(x + h * axis) - at(x - h * axis)) / (2 * h);
    };
    const Vec3d dx = slope({1, 0, 0}), dy = slope({0, 1, 0}), dz = slope({0, 0, 1});
    ExpectNear(Evaluate<double>(Velocity{}, std::array{x.x, x.y, x.z, gain, scale}),
               {dy.z - dz.y, dz.x - dx.z, dx.y - dy.x}, 1e-7);
  }
}

TEST(CurlNoise, DivergenceIsZeroToRoundOff) {
  Rng rng(2);
  double steepest = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vec3<Dual3> v =
        CurlNoise(NoiseTerm<Dual3>{Dual3(0.25), Dual3(0.4), kSeed}, AsDual(RandomPoint(&rng)));
    EXPECT_LE(std::abs(Divergence(v)), 1e-13 * (1 + Steepness(v)));
    steepest = std::max(steepest, Steepness(v));
  }
  EXPECT_GT(steepest, 1);  // [1/s]
}

TEST(CurlNoise, RawPerlinVelocityHasSources) {
  Rng rng(2);
  double sum = 0;
  for (int k = 0; k < 500; ++k) {
    const Vec3<Dual3> v =
        PerlinVelocity(NoiseTerm<Dual3>{Dual3(0.25), Dual3(0.4), kSeed}, AsDual(RandomPoint(&rng)));
    sum += std::abs(Divergence(v)) / Steepness(v);
  }
  EXPECT_GT(sum / 500, 0.1);
}

TEST(CurlNoise, ScalesAsGainOverScaleWithMeanZero) {
  const int n = 100000;
  const auto statistics = [&](double gain, double scale, auto field) {
    Rng rng(3);
    Vec3d mean;
    double squares = 0;
    for (int k = 0; k < n; ++k) {
      const Vec3d x = RandomPoint(&rng, 300 * scale);
      const Vec3d v = Evaluate<double>(field, std::array{x.x, x.y, x.z, gain, scale});
      mean += v / n;
      squares += SquaredNorm(v) / n;
    }
    EXPECT_LT(Norm(mean), 0.02 * std::sqrt(squares));
    return std::sqrt(squares) / (gain / scale);
  };
  const double one = statistics(0.25, 0.4, Velocity{});
  EXPECT_GT(one, 0.5);
  EXPECT_LT(one, 2);
  EXPECT_NEAR(statistics(1.0, 0.6, Velocity{}), one, 0.01);
  const double perlin = statistics(0.25, 0.4, RawPerlin{});
  EXPECT_GT(perlin, 0.2);
  EXPECT_LT(perlin, 1);
}

TEST(CurlNoise, ScalarsAgree) {
  Rng rng(4);
  for (int k = 0; k < 200; ++k) {
    // A scale of 1/2 and multiples of 1/1024 keep every scalar in the same cell.
    const Vec3d x = RandomPoint(&rng, 1e4);
    const std::array<double, 5> in = {std::floor(x.x) / 1024, std::floor(x.y) / 1024,
                                      std::floor(x.z) / 1024, 0.3, 0.5};
    ExpectScalarsAgree(Velocity{}, in);
    ExpectScalarsAgree(Potential{}, in);
    ExpectScalarsAgree(RawPerlin{}, in);
  }
}

TEST(CurlNoise, GradientByPositionGainAndScale) {
  for (const auto& in :
       {std::array{0.13, 1.4, -2.6, 0.25, 0.4}, std::array{2.25, 3.45, 0.77, 1.0, 0.6}}) {
    ExpectGradientMatches(Velocity{}, in);
    ExpectGradientMatches(Potential{}, in);
    ExpectGradientMatches(RawPerlin{}, in);
  }
}

TEST(NoiseTerms, StandStillUnlessTheyEvolve) {
  const NoiseOptions options{.gain = 0.3, .scale = 2, .evolution = 0, .octaves = 1, .seed = 9};
  const auto terms = NoiseTermsAt(options, 0), later = NoiseTermsAt(options, 100);
  ASSERT_EQ(terms.size(), 1u);
  ASSERT_EQ(later.size(), 1u);
  EXPECT_EQ(terms[0].gain, 0.3);
  EXPECT_EQ(terms[0].scale, 2);
  EXPECT_EQ(terms[0].seed, later[0].seed);
  NoiseOptions other = options;
  other.seed = 10;
  EXPECT_NE(NoiseTermsAt(other, 0)[0].seed, terms[0].seed);
}

TEST(NoiseTerms, EvolveWithoutStepsAtConstantStrength) {
  const NoiseOptions options{.gain = 1, .scale = 0.7, .evolution = 2, .octaves = 2, .seed = 9};
  const Vec3d x{0.3, 4.1, -2};
  const auto at = [&](double time) { return Curl(NoisePotential(NoiseTermsAt(options, time), x)); };
  for (const double time : {-3.7, 0.5, 1.9, 2.0, 4.0, 11.3}) {
    EXPECT_LT(Norm(at(time + 1e-7) - at(time - 1e-7)), 1e-5);
    double squares = 0;
    for (const auto& term : NoiseTermsAt(options, time)) squares += term.gain * term.gain;
    EXPECT_NEAR(squares, 1 + 0.25, 1e-12);
  }
  EXPECT_GT(Norm(at(2) - at(0)), 0.1);
  EXPECT_GT(Norm(at(4) - at(2)), 0.1);
}

TEST(NoiseTerms, RefusesWhatMakesNoSense) {
  EXPECT_THROW(NoiseTermsAt({.scale = 0}, 0), std::invalid_argument);
  EXPECT_THROW(NoiseTermsAt({.evolution = -1}, 0), std::invalid_argument);
  EXPECT_THROW(NoiseTermsAt({.octaves = 0}, 0), std::invalid_argument);
}

TEST(CurlNoise, SumOfTermsIsFreeOfSources) {
  const NoiseOptions options{.gain = 1, .scale = 0.7, .evolution = 2, .octaves = 3, .seed = 9};
  std::vector<NoiseTerm<Dual3>> terms;
  for (const auto& term : NoiseTermsAt(options, 0.8)) {
    terms.push_back({Dual3(term.gain), Dual3(term.scale), term.seed});
  }
  ASSERT_EQ(terms.size(), 6u);
  Rng rng(6);
  for (int k = 0; k < 100; ++k) {
    const Vec3<Dual3> v = Curl(NoisePotential(terms, AsDual(RandomPoint(&rng))));
    EXPECT_LE(std::abs(Divergence(v)), 1e-13 * (1 + Steepness(v)));
  }
}

}  // namespace
}  // namespace flocklift
