// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/components.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

GrayImage RandomMask(int width, int height, double share, std::uint64_t seed) {
  GrayImage mask(width, height);
  Rng rng(seed);
  for (auto& pixel : mask.pixels) pixel = rng.Uniform() < share ? 255 : 0;
  return mask;
}

using PixelSet = std::set<std::pair<int, int>>;

// By flood fill.
std::set<PixelSet> BruteForce(const GrayImage& mask) {
  std::set<PixelSet> components;
  std::vector<char> seen(mask.pixels.size(), 0);
  for (int v = 0; v < mask.height; ++v) {
    for (int u = 0; u < mask.width; ++u) {
      std::vector<std::pair<int, int>> stack{{u, v}};
      PixelSet found;
      while (!stack.empty()) {
        const auto [x, y] = stack.back();
        stack.pop_back();
        if (x < 0 || y < 0 || x >= mask.width || y >= mask.height) continue;
        char& mark = seen[static_cast<std::size_t>(y) * mask.width + x];
        if (mark || mask.Row(y)[x] == 0) continue;
        mark = 1;
        found.insert({x, y});
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) stack.push_back({x + dx, y + dy});
        }
      }
      if (!found.empty()) components.insert(found);
    }
  }
  return components;
}

TEST(ComponentsTest, FindsUShapeAsOne) {
  GrayImage mask(5, 3);
  mask.pixels = {1, 0, 0, 0, 1,  //
                 1, 0, 0, 0, 1,  //
                 0, 1, 1, 1, 0};
  const auto components = FindComponents(mask);
  ASSERT_EQ(components.size(), 1u);
  EXPECT_EQ(components[0].area, 7);
  EXPECT_EQ(components[0].left, 0);
  EXPECT_EQ(components[0].right, 4);
  EXPECT_EQ(components[0].top, 0);
  EXPECT_EQ(components[0].bottom, 2);
}

TEST(ComponentsTest, AgreesWithFloodFill) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const GrayImage mask =
        RandomMask(17 + static_cast<int>(seed), 23, 0.1 + 0.02 * static_cast<double>(seed), seed);
    std::set<PixelSet> found;
    for (const Component& c : FindComponents(mask)) {
      PixelSet pixels;
      for (const PixelRun& run : c.runs) {
        for (int u = run.first; u <= run.last; ++u) pixels.insert({u, run.v});
      }
      EXPECT_EQ(static_cast<int>(pixels.size()), c.area);
      for (const auto& [x, y] : pixels) {
        EXPECT_TRUE(x >= c.left && x <= c.right && y >= c.top && y <= c.bottom);
      }
      found.insert(pixels);
    }
    EXPECT_EQ(found, BruteForce(mask)) << "seed " << seed;
  }
}

TEST(ComponentsTest, EmptyMaskHasNone) {
  EXPECT_THAT(FindComponents(GrayImage(16, 16)), testing::IsEmpty());
}

}  // namespace
}  // namespace flocklift
