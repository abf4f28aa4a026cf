// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/subdivide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "simulate/core/rng.h"
#include "simulate/shapes/tetrahedralize.h"
#include "tests/simulate/shapes/block_letter.h"

namespace flocklift {
namespace {

Tetra RandomTetra(std::uint64_t seed) {
  Rng rng(seed);
  Tetra t;
  for (Vec3d& p : t) p = {rng.Normal(), rng.Normal(), rng.Normal()};
  if (Volume(t) < 0) std::swap(t[0], t[1]);
  return t;
}

double VolumeOf(const std::vector<Tetra>& tetrahedra) {
  double sum = 0;
  for (const Tetra& t : tetrahedra) sum += Volume(t);
  return sum;
}

TEST(Subdivide, PiecesAreEquallyLarge) {
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    const Tetra t = RandomTetra(seed);
    for (const Tetra& piece : CutInFour(t)) EXPECT_NEAR(Volume(piece), Volume(t) / 4, 1e-12);
    for (const Tetra& piece : CutInThree(t)) EXPECT_NEAR(Volume(piece), Volume(t) / 3, 1e-12);
    for (const Tetra& piece : CutInTwo(t)) EXPECT_NEAR(Volume(piece), Volume(t) / 2, 1e-12);
  }
}

// A point of the tetrahedron is inside exactly one piece.
TEST(Subdivide, PiecesAreTheWhole) {
  const auto inside = [](const Tetra& t, const Vec3d& p) {
    for (std::size_t k = 0; k < 4; ++k) {
      Tetra part = t;
      part[k] = p;
      if (Volume(part) < 0) return false;
    }
    return true;
  };
  const Tetra t = RandomTetra(5);
  Rng rng(9);
  for (int n = 0; n < 200; ++n) {
    double w[4], sum = 0;
    for (double& x : w) sum += x = -std::log(rng.Uniform());
    const Vec3d p = (w[0] * t[0] + w[1] * t[1] + w[2] * t[2] + w[3] * t[3]) / sum;
    int four = 0, three = 0, two = 0;
    for (const Tetra& piece : CutInFour(t)) four += inside(piece, p) ? 1 : 0;
    for (const Tetra& piece : CutInThree(t)) three += inside(piece, p) ? 1 : 0;
    for (const Tetra& piece : CutInTwo(t)) two += inside(piece, p) ? 1 : 0;
    EXPECT_EQ(four, 1);
    EXPECT_EQ(three, 1);
    EXPECT_EQ(two, 1);
  }
}

TEST(Subdivide, TheCountIsExactAndTheVolumeKept) {
  const std::vector<Tetra> start = Separate(Tetrahedralize(Ball(1, 8), {.cell = 0.6}));
  const double volume = VolumeOf(start);
  for (std::size_t more : {0, 1, 2, 3, 4, 5, 100, 1000, 5000}) {
    const std::size_t count = start.size() + more;
    const std::vector<Tetra> result = SubdivideTo(count, start);
    ASSERT_EQ(result.size(), count);
    EXPECT_NEAR(VolumeOf(result), volume, 1e-12 * volume);
    for (const Tetra& t : result) EXPECT_GT(Volume(t), 0);
  }
}

// From one on: every count passes through its own mixture of cuts.
TEST(Subdivide, EveryCountFromOne) {
  const std::vector<Tetra> one{RandomTetra(7)};
  for (std::size_t count = 1; count <= 70; ++count) {
    const std::vector<Tetra> result = SubdivideTo(count, one);
    ASSERT_EQ(result.size(), count);
    EXPECT_NEAR(VolumeOf(result), Volume(one[0]), 1e-12);
  }
}

TEST(Subdivide, TheLargestAreCutFirst) {
  const Tetra small{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Tetra large = small;
  for (Vec3d& p : large) p *= 3;
  const std::vector<Tetra> result = SubdivideTo(5, {small, large});
  EXPECT_NEAR(Volume(result[0]), Volume(small), 1e-15);
  EXPECT_NEAR(Volume(result[1]), Volume(large) / 4, 1e-12);
}

TEST(Subdivide, RefusesFewerThanThereAre) {
  const std::vector<Tetra> two{RandomTetra(1), RandomTetra(2)};
  EXPECT_THROW(SubdivideTo(1, two), std::invalid_argument);
  EXPECT_THROW(SubdivideTo(5, {}), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
