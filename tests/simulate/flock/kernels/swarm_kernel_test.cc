// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/kernels/swarm_kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/flock/swarm_velocity.h"

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

struct Nodes {
  std::vector<float> numbers;
  SwarmGrid grid{};
};
Nodes MakeNodes(int nx, int ny, int nz) {
  Nodes nodes;
  Rng rng(2);
  for (int k = 0; k < 4 * nx * ny * nz; ++k) {
    nodes.numbers.push_back(static_cast<float>(rng.Uniform(-1, 1)));
  }
  nodes.grid = {nodes.numbers.data(), -5, -4, -2, 2, nx, ny, nz};
  return nodes;
}

struct Velocities {
  std::vector<float> x, y, z, distance;

  friend bool operator==(const Velocities&, const Velocities&) = default;
};
Velocities RunKernel(SwarmKernel kernel, const Animals& animals,
                     const std::vector<SwarmNoise>& noise, bool curl, const SwarmGrid& grid) {
  Velocities v;
  for (auto* column : {&v.x, &v.y, &v.z, &v.distance}) column->resize(kPadded);
  kernel({animals.x.data(), animals.y.data(), animals.z.data(), noise.data(),
          static_cast<int>(noise.size()), curl, grid, 1.5F, v.x.data(), v.y.data(), v.z.data(),
          v.distance.data()},
         0, kAnimals);
  for (auto* column : {&v.x, &v.y, &v.z, &v.distance}) column->resize(kAnimals);
  return v;
}

const std::vector<SwarmNoise> kOne = {{0.25F, 0.4F, 7}};
const std::vector<SwarmNoise> kTwo = {{1.0F, 0.6F, 8}, {0.5F, 0.3F, 0xFFFFFFFFU}};

TEST(SwarmKernel, EveryVariantOfThisMachineGivesTheSameBytes) {
  const Animals animals = MakeAnimals();
  const Nodes nodes = MakeNodes(20, 24, 9), flat = MakeNodes(17, 5, 2);
  int variants = 0;
  for (const SwarmKernelVariant& variant : kSwarmKernels) {
    if (!variant.supported()) continue;
    ++variants;
    for (const auto& noise : {std::vector<SwarmNoise>{}, kOne, kTwo}) {
      for (const bool curl : {true, false}) {
        for (const SwarmGrid& grid : {SwarmGrid{}, nodes.grid, flat.grid}) {
          SCOPED_TRACE(std::string(variant.name));
          EXPECT_EQ(RunKernel(variant.kernel, animals, noise, curl, grid),
                    RunKernel(SwarmKernelScalar, animals, noise, curl, grid));
        }
      }
    }
  }
  EXPECT_GE(variants, 1);
}

TEST(SwarmKernel, IsNoisePlusGuide) {
  const Animals animals = MakeAnimals();
  const Nodes nodes = MakeNodes(20, 24, 9);
  const Velocities v = RunKernel(SwarmKernelScalar, animals, kTwo, true, nodes.grid);
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
    const GuideSample<double> guide = SampleGuide<double>(nodes.grid, x);
    expected += 1.5 * guide.direction;
    EXPECT_NEAR(static_cast<double>(v.x[k]), expected.x, 2e-4);
    EXPECT_NEAR(static_cast<double>(v.y[k]), expected.y, 2e-4);
    EXPECT_NEAR(static_cast<double>(v.z[k]), expected.z, 2e-4);
    EXPECT_NEAR(static_cast<double>(v.distance[k]), guide.distance, 1e-5);
  }
}

TEST(Guide, IsLinearBetweenNodesAndConstantBeyond) {
  Nodes nodes = MakeNodes(4, 3, 5);
  const auto number = [](const Vec3d& at, int n) { return 0.3 * at.x - 0.2 * at.y + n * at.z + n; };
  for (int c = 0; c < 5; ++c) {
    for (int b = 0; b < 3; ++b) {
      for (int a = 0; a < 4; ++a) {
        const Vec3d at{-5 + 0.5 * a, -4 + 0.5 * b, -2 + 0.5 * c};
        for (int n = 0; n < 4; ++n) {
          nodes.numbers[static_cast<std::size_t>(4 * ((c * 3 + b) * 4 + a) + n)] =
              static_cast<float>(number(at, n));
        }
      }
    }
  }
  const auto expect_at = [&](const Vec3d& x, const Vec3d& seen) {
    const GuideSample<double> guide = SampleGuide<double>(nodes.grid, x);
    EXPECT_NEAR(guide.direction.x, number(seen, 0), 1e-6);
    EXPECT_NEAR(guide.direction.y, number(seen, 1), 1e-6);
    EXPECT_NEAR(guide.direction.z, number(seen, 2), 1e-6);
    EXPECT_NEAR(guide.distance, number(seen, 3), 1e-6);
  };
  expect_at({-4.3, -3.6, -0.1}, {-4.3, -3.6, -0.1});
  expect_at({-5, -4, -2}, {-5, -4, -2});
  expect_at({-3.5, -3, 0}, {-3.5, -3, 0});     // the last node
  expect_at({-9, 100, -0.4}, {-5, -3, -0.4});  // beyond
}

}  // namespace
}  // namespace flocklift
