// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/kernels/swarm_kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/flock/swarm_velocity.h"
#include "tests/simulate/forces/scalars.h"

namespace flocklift {
namespace {

constexpr std::uint32_t kAnimals = 1003;  // no multiple of a pack
constexpr std::size_t kPadded = kAnimals + 16;

struct Animals {
  std::vector<float> x, y, z;
};
Animals MakeAnimals() {
  Rng rng(1);
  Animals animals;
  for (std::size_t k = 0; k < kPadded; ++k) {  // some beyond the grid
    animals.x.push_back(static_cast<float>(rng.Uniform(-6, 6)));
    animals.y.push_back(static_cast<float>(rng.Uniform(-4, 9)));
    animals.z.push_back(static_cast<float>(rng.Uniform(-3, 3)));
  }
  animals.x[3] = animals.y[3] = animals.z[3] = 0;  // on the lattice, and on a node
  return animals;
}

struct Cells {
  std::vector<std::int8_t> bytes;
  SwarmGuide guide{};
};
Cells MakeCells(int nx, int ny, int nz) {
  Cells cells;
  Rng rng(2);
  for (int k = 0; k < kGuideCellBytes * nx * ny * nz; ++k) {
    cells.bytes.push_back(static_cast<std::int8_t>(static_cast<int>(rng.Below(255)) - 127));
  }
  cells.guide = {cells.bytes.data(), -5, -4, -2, 2, nx, ny, nz, 1.5F, 3};
  return cells;
}

struct Velocities {
  std::vector<float> x, y, z, distance;

  friend bool operator==(const Velocities&, const Velocities&) = default;
};
Velocities RunKernel(SwarmKernel kernel, const Animals& animals,
                     const std::vector<SwarmNoise>& noise, bool curl, const SwarmGuide& guide) {
  Velocities v;
  for (auto* column : {&v.x, &v.y, &v.z, &v.distance}) column->resize(kPadded);
  kernel({animals.x.data(), animals.y.data(), animals.z.data(), noise.data(),
          static_cast<int>(noise.size()), curl, guide, v.x.data(), v.y.data(), v.z.data(),
          v.distance.data()},
         0, kAnimals);
  for (auto* column : {&v.x, &v.y, &v.z, &v.distance}) column->resize(kAnimals);
  return v;
}

const std::vector<SwarmNoise> kOne = {{0.25F, 0.4F, 7}};
const std::vector<SwarmNoise> kTwo = {{1.0F, 0.6F, 8}, {0.5F, 0.3F, 0xFFFFFFFFU}};

TEST(SwarmKernel, EveryVariantOfThisMachineGivesTheSameBytes) {
  const Animals animals = MakeAnimals();
  const Cells cells = MakeCells(20, 24, 9), flat = MakeCells(17, 5, 1);
  int variants = 0;
  for (const SwarmKernelVariant& variant : kSwarmKernels) {
    if (!variant.supported()) continue;
    ++variants;
    for (const auto& noise : {std::vector<SwarmNoise>{}, kOne, kTwo}) {
      for (const bool curl : {true, false}) {
        for (const SwarmGuide& guide : {SwarmGuide{}, cells.guide, flat.guide}) {
          SCOPED_TRACE(std::string(variant.name));
          EXPECT_EQ(RunKernel(variant.kernel, animals, noise, curl, guide),
                    RunKernel(SwarmKernelScalar, animals, noise, curl, guide));
        }
      }
    }
  }
  EXPECT_GE(variants, 1);
}

TEST(SwarmKernel, IsNoisePlusGuide) {
  const Animals animals = MakeAnimals();
  const Cells cells = MakeCells(20, 24, 9);
  const Velocities v = RunKernel(SwarmKernelScalar, animals, kTwo, true, cells.guide);
  for (std::size_t k = 0; k < kAnimals; ++k) {
    // A hair within a cell the float and the double may see different cells; noise and guide are
    // continuous.
    const Vec3d x{static_cast<double>(animals.x[k]), static_cast<double>(animals.y[k]),
                  static_cast<double>(animals.z[k])};
    Vec3d expected;
    for (const SwarmNoise& n : kTwo) {
      expected += CurlNoise(
          NoiseTerm<double>{static_cast<double>(n.gain), static_cast<double>(n.scale), n.seed}, x);
    }
    const GuideSample<double> guide = SampleGuide<double>(cells.guide, x);
    expected += guide.velocity;
    EXPECT_NEAR(static_cast<double>(v.x[k]), expected.x, 2e-4);
    EXPECT_NEAR(static_cast<double>(v.y[k]), expected.y, 2e-4);
    EXPECT_NEAR(static_cast<double>(v.z[k]), expected.z, 2e-4);
    EXPECT_NEAR(static_cast<double>(v.distance[k]), guide.distance, 1e-5);
  }
}

TEST(CellKernel, EveryVariantNumbersTheSameCells) {
  const Animals animals = MakeAnimals();
  constexpr std::uint32_t kPoints = kAnimals / 8 * 8;
  for (const float shift : {0.0F, 0.5F}) {
    std::vector<std::uint32_t> cells(kPoints);
    for (const SwarmKernelVariant& variant : kSwarmKernels) {
      if (!variant.supported()) continue;
      variant.cells({animals.x.data(), animals.y.data(), animals.z.data(), 2.5F, shift, 1000,
                     1000000, cells.data()},
                    0, kPoints);
      for (std::size_t k = 0; k < kPoints; ++k) {
        const auto cell = [shift](float x) {
          return static_cast<int>(std::floor(x * 2.5F - shift));
        };
        EXPECT_EQ(static_cast<int>(cells[k]),
                  cell(animals.x[k]) + 1000 * cell(animals.y[k]) + 1000000 * cell(animals.z[k]));
      }
    }
  }
}

TEST(CompanyKernel, EveryVariantSeesTheSameBits) {
  const Animals animals = MakeAnimals();
  constexpr std::uint32_t kPoints = kAnimals / 8 * 8, kMask = 1023, kAcrossY = 37, kAcrossZ = 990;
  std::vector<std::uint8_t> bits((kMask + 1) / 8 + 4);
  Rng rng(3);
  for (std::uint32_t k = 0; k <= kMask; ++k) {
    if (rng.Below(8) == 0) bits[k / 8] |= static_cast<std::uint8_t>(1U << k % 8);
  }
  bits[(kMask + 1) / 8] = bits[0];
  std::vector<std::uint32_t> expected, expected_lowest;
  for (std::uint32_t k = 0; k < kPoints; ++k) {
    const auto cell = [](float x) {
      return static_cast<std::uint32_t>(static_cast<int>(std::floor(x * 2.5F - 0.5F)));
    };
    const std::uint32_t lowest =
        cell(animals.x[k]) + cell(animals.y[k]) * kAcrossY + cell(animals.z[k]) * kAcrossZ;
    int seen = 0;
    for (std::uint32_t corner = 0; corner < 8; ++corner) {
      const std::uint32_t bit =
          (lowest + (corner & 1) + (corner >> 1 & 1) * kAcrossY + (corner >> 2) * kAcrossZ) & kMask;
      seen += bits[bit / 8] >> bit % 8 & 1;
    }
    if (seen < 2) continue;
    expected.push_back(k);
    expected_lowest.push_back(lowest);
  }
  EXPECT_GT(expected.size(), 100);
  EXPECT_LT(expected.size(), kPoints - 100);
  for (const SwarmKernelVariant& variant : kSwarmKernels) {
    if (!variant.supported()) continue;
    std::vector<std::uint32_t> found(kPoints), lowest(kPoints);
    const CompanyJob job{{animals.x.data(), animals.y.data(), animals.z.data(), 2.5F, 0.5F,
                          kAcrossY, kAcrossZ, nullptr},
                         bits.data(),
                         kMask};
    const std::uint32_t count = variant.company(job, 0, kPoints, found.data(), lowest.data());
    found.resize(count);
    lowest.resize(count);
    EXPECT_EQ(found, expected);
    EXPECT_EQ(lowest, expected_lowest);
  }
}

TEST(Guide, IsLinearWithinItsCellsAndConstantBeyond) {
  Cells cells = MakeCells(3, 2, 4);
  // Whole numbers at the corners, a metre being two cells.
  const auto number = [](const Vec3d& at, int n) {
    return 10 * at.x - 8 * at.y + 6 * n * at.z + n;
  };
  for (int cell = 0; cell < 3 * 2 * 4; ++cell) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3d at{-5 + 0.5 * (cell % 3 + corner % 2), -4 + 0.5 * (cell / 3 % 2 + corner / 2 % 2),
                     -2 + 0.5 * (cell / 6 + corner / 4)};
      for (int n = 0; n < 4; ++n) {
        cells.bytes[static_cast<std::size_t>(kGuideCellBytes * cell + 4 * corner + n)] =
            static_cast<std::int8_t>(number(at, n));
      }
    }
  }
  const auto expect_at = [&](const Vec3d& x, const Vec3d& seen) {
    const GuideSample<double> guide = SampleGuide<double>(cells.guide, x);
    ExpectNear(guide.velocity, 1.5 / 127 * Vec3d{number(seen, 0), number(seen, 1), number(seen, 2)},
               1e-6);
    EXPECT_NEAR(guide.distance, 3.0 / 127 * number(seen, 3), 1e-6);
  };
  expect_at({-4.3, -3.6, -0.1}, {-4.3, -3.6, -0.1});
  expect_at({-5, -4, -2}, {-5, -4, -2});
  expect_at({-3.5, -3, 0}, {-3.5, -3, 0});     // the last corner
  expect_at({-9, 100, -0.4}, {-5, -3, -0.4});  // beyond
}

}  // namespace
}  // namespace flocklift
