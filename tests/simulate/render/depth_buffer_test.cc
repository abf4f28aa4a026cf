// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/depth_buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

constexpr int kWidth = 40, kHeight = 30;
constexpr std::array<std::uint8_t, 3> kTone{10, 20, 30};
using Triangle = std::array<ImageCorner, 3>;

Triangle RandomTriangle(std::uint64_t trial, double low, double high) {
  Rng rng(3, trial);
  Triangle t;
  for (ImageCorner& c : t) {
    c = {{rng.Uniform(low, high + kWidth - 1), rng.Uniform(low, high + kHeight - 1)},
         rng.Uniform(0.1, 1)};
  }
  return t;
}

double AreaOf(const Triangle& t) {
  const Vec2d &a = t[0].pixel, &b = t[1].pixel, &c = t[2].pixel;
  return 0.5 * std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
}

// Nearness by barycentric coordinates; nothing outside or within `rim` of the border.
std::optional<double> Oracle(const Triangle& t, double x, double y, double rim) {
  const Vec2d &a = t[0].pixel, &b = t[1].pixel, &c = t[2].pixel;
  const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  const double wb = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / area;
  const double wc = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
  const double wa = 1 - wb - wc;
  if (std::min({wa, wb, wc}) < rim) return std::nullopt;
  return wa * t[0].nearness + wb * t[1].nearness + wc * t[2].nearness;
}

int SamplesOf(const DepthBuffer& buffer) {
  int count = 0;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) count += buffer.Covered(u, v);
  }
  return count;
}

TEST(DepthBufferTest, SamplesCountTheArea) {
  double exact = 0, counted = 0;
  for (std::uint64_t trial = 0; trial < 300; ++trial) {
    const Triangle t = RandomTriangle(trial, 0, 0);
    DepthBuffer buffer(kWidth, kHeight);
    buffer.Draw(t, kTone);
    exact += AreaOf(t);
    counted += SamplesOf(buffer) / 4.0;
    // The border passes through at most so many samples.
    EXPECT_NEAR(SamplesOf(buffer) / 4.0, AreaOf(t), 8) << trial;
  }
  EXPECT_NEAR(counted / exact, 1, 0.003);
}

TEST(DepthBufferTest, NeighboursLeaveNoGapAndShareNoSample) {
  // A net of triangles with corners moved about, some of them onto samples.
  constexpr int kCells = 6;
  const auto corner = [](int i, int j) {
    Rng rng(7, static_cast<std::uint64_t>(i * 100 + j));
    const bool rim = i == 0 || j == 0 || i == kCells || j == kCells;
    const double du = rim ? 0 : std::round(16 * rng.Uniform(-1, 1)) / 8;
    const double dv = rim ? 0 : std::round(16 * rng.Uniform(-1, 1)) / 8;
    return ImageCorner{{4.375 + 5 * i + du, 2.125 + 4 * j + dv}, 1};
  };
  std::vector<int> covered(kWidth * kHeight);
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      for (const Triangle& t :
           {Triangle{corner(i, j), corner(i + 1, j), corner(i, j + 1)},
            Triangle{corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1)}}) {
        DepthBuffer buffer(kWidth, kHeight);
        buffer.Draw(t, kTone);
        for (int k = 0; k < kWidth * kHeight; ++k) {
          covered[static_cast<std::size_t>(k)] += buffer.Covered(k % kWidth, k / kWidth);
        }
      }
    }
  }
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      int expected = 0;
      for (const Vec2d& place : DepthBuffer::kPlace) {
        const double x = u + place.x, y = v + place.y;
        expected += x >= 4.375 && x < 34.375 && y >= 2.125 && y < 26.125 ? 1 : 0;
      }
      EXPECT_EQ(covered[static_cast<std::size_t>(v * kWidth + u)], expected) << u << " " << v;
    }
  }
}

TEST(DepthBufferTest, EachSampleKeepsTheNearest) {
  std::vector<Triangle> triangles;
  for (std::uint64_t k = 0; k < 12; ++k) triangles.push_back(RandomTriangle(k, -15, 15));
  DepthBuffer buffer(kWidth, kHeight), backwards(kWidth, kHeight);
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    buffer.Draw(triangles[k], {static_cast<std::uint8_t>(k), 0, 0});
    backwards.Draw(triangles[triangles.size() - 1 - k],
                   {static_cast<std::uint8_t>(triangles.size() - 1 - k), 0, 0});
  }
  int checked = 0;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      for (int s = 0; s < DepthBuffer::kSamples; ++s) {
        EXPECT_EQ(buffer.Nearness(u, v, s), backwards.Nearness(u, v, s));
        const Vec2d place = DepthBuffer::kPlace[static_cast<std::size_t>(s)];
        double nearest = 0, second = 0;
        std::size_t which = 0;
        bool on_border = false;
        for (std::size_t k = 0; k < triangles.size(); ++k) {
          const auto inside = Oracle(triangles[k], u + place.x, v + place.y, 1e-9);
          if (inside.has_value() !=
              Oracle(triangles[k], u + place.x, v + place.y, -1e-9).has_value()) {
            on_border = true;
          }
          if (!inside) continue;
          if (*inside > nearest) {
            second = nearest;
            nearest = *inside;
            which = k;
          } else {
            second = std::max(second, *inside);
          }
        }
        if (on_border) continue;
        EXPECT_NEAR(buffer.Nearness(u, v, s), nearest, 1e-5);
        if (nearest - second < 1e-5) continue;
        EXPECT_EQ(buffer.Tone(u, v, s)[0], which);
        EXPECT_EQ(buffer.Behind(u, v, static_cast<float>(nearest)) <= buffer.Covered(u, v), true);
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 2000);
}

TEST(DepthBufferTest, ShadeIsLinearBetweenTheCorners) {
  DepthBuffer buffer(kWidth, kHeight);
  const Triangle t{ImageCorner{{0, 0}, 1, 0}, ImageCorner{{40, 0}, 1, 1},
                   ImageCorner{{0, 40}, 1, 0}};
  buffer.Draw(t, {200, 100, 0});
  for (const int u : {2, 10, 18}) {
    const double shade = (u + DepthBuffer::kPlace[0].x) / 40;
    EXPECT_NEAR(buffer.Tone(u, 10, 0)[0], 200 * shade, 0.51);
    EXPECT_NEAR(buffer.Tone(u, 10, 0)[1], 100 * shade, 0.51);
    EXPECT_EQ(buffer.Tone(u, 10, 0)[2], 0);
  }
}

TEST(DepthBufferTest, DrawsOnlyTheChosenSamplesAndClears) {
  DepthBuffer buffer(kWidth, kHeight);
  const Triangle all{ImageCorner{{-200, -200}, 0.5}, ImageCorner{{300, -200}, 0.5},
                     ImageCorner{{0, 500}, 0.5}};
  EXPECT_TRUE(buffer.empty());
  buffer.Draw(all, kTone, 0b0101);
  EXPECT_FALSE(buffer.empty());
  EXPECT_EQ(SamplesOf(buffer), 2 * kWidth * kHeight);
  EXPECT_EQ(buffer.Nearness(3, 3, 1), 0);
  EXPECT_EQ(buffer.Nearness(3, 3, 2), 0.5F);
  EXPECT_EQ(buffer.Behind(3, 3, 0.6F), 2);
  EXPECT_EQ(buffer.Behind(3, 3, 0.4F), 0);
  buffer.Clear();
  EXPECT_TRUE(buffer.empty());
  EXPECT_EQ(SamplesOf(buffer), 0);
  EXPECT_GE(buffer.Touched(4).first, buffer.Touched(4).last);
}

TEST(DepthBufferTest, WhatHasNoAreaIsNotThere) {
  DepthBuffer buffer(kWidth, kHeight);
  buffer.Draw({ImageCorner{{1, 1}, 1}, ImageCorner{{9, 9}, 1}, ImageCorner{{5, 5}, 1}}, kTone);
  buffer.Draw({ImageCorner{{1, 1}, 1}, ImageCorner{{NAN, 9}, 1}, ImageCorner{{5, 7}, 1}}, kTone);
  EXPECT_TRUE(buffer.empty());
}

}  // namespace
}  // namespace flocklift
