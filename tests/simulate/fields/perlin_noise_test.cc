// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/perlin_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/flock/kernels/lattice_pack.h"
#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

// Perlin's algorithm as his paper describes it, with a table of our own (any permutation does):
// hash by the table, gradient by the low four bits, nested interpolation.
class TablePerlin {
 public:
  TablePerlin() {
    std::iota(table_.begin(), table_.begin() + 256, 0U);
    Rng rng(11);
    for (std::uint32_t k = 255; k > 0; --k) std::swap(table_[k], table_[rng.Below(k + 1)]);
    std::copy(table_.begin(), table_.begin() + 256, table_.begin() + 256);
  }

  std::uint32_t Hash(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    return table_[table_[table_[x & 255] + (y & 255)] + (z & 255)];
  }

  double At(double x, double y, double z) const {
    const double lx = std::floor(x), ly = std::floor(y), lz = std::floor(z);
    const double fx = x - lx, fy = y - ly, fz = z - lz;
    const auto corner = [&](int a, int b, int c) {
      return Slope(Hash(static_cast<std::uint32_t>(static_cast<int>(lx) + a),
                        static_cast<std::uint32_t>(static_cast<int>(ly) + b),
                        static_cast<std::uint32_t>(static_cast<int>(lz) + c)),
                   fx - a, fy - b, fz - c);
    };
    const double sx = Blend(fx), sy = Blend(fy), sz = Blend(fz);
    const auto along_x = [&](int b, int c) {
      return std::lerp(corner(0, b, c), corner(1, b, c), sx);
    };
    return std::lerp(std::lerp(along_x(0, 0), along_x(1, 0), sy),
                     std::lerp(along_x(0, 1), along_x(1, 1), sy), sz);
  }

 private:
  static double Blend(double t) {
    return 6 * std::pow(t, 5) - 15 * std::pow(t, 4) + 10 * t * t * t;
  }
  // "Twelve directions from the centre of a cube to its edges", four of them twice: with 12 and 14
  // (1,1,0), (-1,1,0); with 13 and 15 (0,-1,1), (0,-1,-1).
  static double Slope(std::uint32_t hash, double x, double y, double z) {
    switch (hash & 15) {
      case 0:
        return x + y;
      case 1:
        return -x + y;
      case 2:
        return x - y;
      case 3:
        return -x - y;
      case 4:
        return x + z;
      case 5:
        return -x + z;
      case 6:
        return x - z;
      case 7:
        return -x - z;
      case 8:
        return y + z;
      case 9:
        return -y + z;
      case 10:
        return y - z;
      case 11:
        return -y - z;
      case 12:
        return x + y;
      case 13:
        return -y + z;
      case 14:
        return -x + y;
      default:
        return -y - z;
    }
  }

  std::array<std::uint32_t, 512> table_{};
};

// That table as the hash of our noise.
struct TableHash {
  const TablePerlin* table;
  std::uint32_t operator()(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    return table->Hash(x, y, z) << LatticeShift(0);
  }
};

// (value of noise 0, of noise 1, of noise 2), and the gradient of one.
struct Three {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    const NoiseCell<T> cell = MakeNoiseCell(LatticeHash{7}, Vec3<T>{in[0], in[1], in[2]});
    return {NoiseInCell<0>(cell).value, NoiseInCell<1>(cell).value, NoiseInCell<2>(cell).value};
  }
};
template <int kNoise>
struct Gradient {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    return NoiseInCell<kNoise>(MakeNoiseCell(LatticeHash{7}, Vec3<T>{in[0], in[1], in[2]}))
        .gradient;
  }
};

Vec3d RandomPoint(Rng* rng, double size = 20) {
  return {rng->Uniform(-size, size), rng->Uniform(-size, size), rng->Uniform(-size, size)};
}
std::array<double, 3> AsArray(const Vec3d& x) { return {x.x, x.y, x.z}; }

TEST(PerlinNoise, IsTheDefinitionOf2002) {
  const TablePerlin reference;
  Rng rng(1);
  for (int k = 0; k < 2000; ++k) {
    const Vec3d x = RandomPoint(&rng);
    EXPECT_NEAR(NoiseInCell<0>(MakeNoiseCell(TableHash{&reference}, x)).value,
                reference.At(x.x, x.y, x.z), 1e-14);
  }
}

TEST(PerlinNoise, ByHand) {
  // In the middle of a cell all weights are 1/8 and v_c = g_c . (1/2 - c).
  const auto flat = [](std::uint32_t, std::uint32_t, std::uint32_t) {
    return 0U;
  };  // g = (1, 1, 0)
  const NoiseSample<double> middle = NoiseInCell<0>(MakeNoiseCell(flat, Vec3d{4.5, -2.5, 0.5}));
  EXPECT_DOUBLE_EQ(middle.value, 0);
  // d_x: mean g_x + s'(1/2) (mean over c_x = 1 of v - mean over c_x = 0) = 1 + 15/8 (-1) = -7/8.
  EXPECT_DOUBLE_EQ(middle.gradient.x, -0.875);
  EXPECT_DOUBLE_EQ(middle.gradient.y, -0.875);
  EXPECT_DOUBLE_EQ(middle.gradient.z, 0);
}

TEST(PerlinNoise, IsZeroOnTheLatticeWithTheGradientThere) {
  const auto third = [](std::uint32_t, std::uint32_t, std::uint32_t) { return 6U << 28; };
  for (const Vec3d& x : {Vec3d{0, 0, 0}, Vec3d{3, -4, 5}}) {
    const NoiseSample<double> sample = NoiseInCell<0>(MakeNoiseCell(third, x));
    EXPECT_EQ(sample.value, 0);
    EXPECT_EQ(sample.gradient, (Vec3d{1, 0, -1}));
  }
}

TEST(PerlinNoise, GradientsAreTwelveEdgesOfTheCube) {
  int length = 0;
  for (const auto& g : kDoubledGradients) {
    int zeros = 0;
    for (const signed char component : g) {
      zeros += component == 0 ? 1 : 0;
      length += component * component;
    }
    EXPECT_EQ(zeros, 1);
  }
  EXPECT_EQ(length, 16 * 8);
}

TEST(PerlinNoise, GradientMatchesDifferences) {
  Rng rng(2);
  for (int k = 0; k < 50; ++k) {
    const Vec3d x = RandomPoint(&rng);
    const NoiseCell<double> cell = MakeNoiseCell(LatticeHash{7}, x);
    const Vec3d gradients[3] = {NoiseInCell<0>(cell).gradient, NoiseInCell<1>(cell).gradient,
                                NoiseInCell<2>(cell).gradient};
    const double h = 1e-5;
    for (const Vec3d& axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
      const Vec3d slope = (Evaluate<double>(Three{}, AsArray(x + h * axis)) -
                           Evaluate<double>(Three{}, AsArray(x - h * axis))) /
                          (2 * h);
      EXPECT_NEAR(Dot(gradients[0], axis), slope.x, 1e-8);
      EXPECT_NEAR(Dot(gradients[1], axis), slope.y, 1e-8);
      EXPECT_NEAR(Dot(gradients[2], axis), slope.z, 1e-8);
    }
  }
}

TEST(PerlinNoise, DerivativesByDualNumbers) {
  for (const auto& x : {std::array{0.3, 1.4, -2.6}, std::array{5.25, -7.4, 0.7}}) {
    ExpectGradientMatches(Three{}, x);
    ExpectGradientMatches(Gradient<0>{}, x);
    ExpectGradientMatches(Gradient<2>{}, x);
  }
}

TEST(PerlinNoise, ScalarsAgree) {
  Rng rng(3);
  for (int k = 0; k < 200; ++k) {
    // Multiples of 1/1024: the same number, hence the same cell, for every scalar.
    const Vec3d x = RandomPoint(&rng, 1e4);
    const std::array<double, 3> in = {std::floor(x.x) / 1024, std::floor(x.y) / 1024,
                                      std::floor(x.z) / 1024};
    ExpectScalarsAgree(Three{}, in);
    ExpectScalarsAgree(Gradient<0>{}, in);
    ExpectScalarsAgree(Gradient<1>{}, in);
    ExpectScalarsAgree(Gradient<2>{}, in);
  }
}

TEST(PerlinNoise, PacksFindTheGradientsOfTheTable) {
  using Lane = Lattice<Pack>;
  for (std::uint32_t word = 0; word < 4096; ++word) {
    const std::uint32_t bits = word << 20 | 0x55555U;
    EXPECT_EQ(Values(Lane::DoubledGradient<0>(Lane::Bits(bits))),
              Values(Lattice<double>::DoubledGradient<0>(bits)));
    EXPECT_EQ(Values(Lane::DoubledGradient<1>(Lane::Bits(bits))),
              Values(Lattice<double>::DoubledGradient<1>(bits)));
    EXPECT_EQ(Values(Lane::DoubledGradient<2>(Lane::Bits(bits))),
              Values(Lattice<double>::DoubledGradient<2>(bits)));
  }
}

TEST(PerlinNoise, IsTwiceContinuouslyDifferentiableAcrossCells) {
  Rng rng(4);
  const double h = 1e-9;
  for (int k = 0; k < 100; ++k) {
    Vec3d before = RandomPoint(&rng);
    before.x = std::floor(before.x);
    const Vec3d after = before + Vec3d{h, 0, 0};
    before -= Vec3d{h, 0, 0};
    ExpectNear(Evaluate<double>(Three{}, AsArray(after)),
               Evaluate<double>(Three{}, AsArray(before)), 1e-8);
    ExpectNear(Evaluate<double>(Gradient<1>{}, AsArray(after)),
               Evaluate<double>(Gradient<1>{}, AsArray(before)), 1e-7);
    using Dual = ceres::Jet<double, 1>;
    const auto slope = [](const Vec3d& x) {
      const Dual at[3] = {Dual(x.x, 0), Dual(x.y), Dual(x.z)};
      const Vec3<Dual> gradient = Gradient<1>{}(at);
      return Vec3d{gradient.x.v[0], gradient.y.v[0], gradient.z.v[0]};
    };
    ExpectNear(slope(after), slope(before), 1e-6);
  }
}

TEST(PerlinNoise, StaysWithinItsBoundWithMeanZero) {
  Rng rng(5);
  const int n = 200000;
  Vec3d sum, squares, products;
  for (int k = 0; k < n; ++k) {
    const Vec3d v = Evaluate<double>(Three{}, AsArray(RandomPoint(&rng, 500)));
    EXPECT_LE(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}), 1.04);
    sum += v;
    squares += {v.x * v.x, v.y * v.y, v.z * v.z};
    products += {v.x * v.y, v.y * v.z, v.z * v.x};
  }
  // The sd of the mean of n values of sd 0.27 is 0.0006; of their products 0.00016.
  ExpectNear(sum / n, {0, 0, 0}, 0.003);
  ExpectNear(products / n, {0, 0, 0}, 0.001);  // the three are independent
  EXPECT_NEAR(squares.x, squares.y, 0.02 * squares.x);
  EXPECT_NEAR(squares.x, squares.z, 0.02 * squares.x);
}

TEST(LatticeHash, UsesAllGradientsEquallyAndDoesNotRepeatNearby) {
  std::array<int, 16> counts[3] = {};
  for (std::uint32_t x = 0; x < 40; ++x) {
    for (std::uint32_t y = 0; y < 40; ++y) {
      for (std::uint32_t z = 0; z < 40; ++z) {
        const std::uint32_t bits = LatticeHash{3}(x - 20, y - 20, z - 20);
        for (int k = 0; k < 3; ++k) ++counts[k][bits >> LatticeShift(k) & 15];
      }
    }
  }
  for (const auto& of_noise : counts) {  // 4000 each, sd 61
    for (const int count : of_noise) EXPECT_NEAR(count, 4000, 300);
  }
  std::vector<std::uint32_t> along;
  for (std::uint32_t x = 0; x < 4096; ++x) along.push_back(LatticeHash{3}(x, 5U, 9U));
  std::sort(along.begin(), along.end());
  EXPECT_EQ(std::adjacent_find(along.begin(), along.end()), along.end());
}

}  // namespace
}  // namespace flocklift
