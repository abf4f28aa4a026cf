// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/media/draw.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

namespace flocklift {
namespace {

constexpr Color kWhite{255, 255, 255};

// Sum and centroid of the light in a picture that was black.
struct Light {
  double area = 0, u = 0, v = 0;
  explicit Light(const Image& image) {
    for (int row = 0; row < image.height; ++row) {
      for (int column = 0; column < image.width; ++column) {
        const double value = image.Row(row)[3 * column] / 255.0;
        area += value;
        u += value * column;
        v += value * row;
      }
    }
    u /= area;
    v /= area;
  }
};

TEST(DrawTest, LineHasItsAreaAndItsCentroid) {
  for (const double angle : {0.0, 0.3, 0.8, std::numbers::pi / 2, 2.2}) {
    Image image(100, 100);
    const Vec2d middle{50.3, 48.6};
    const Vec2d half{30 * std::cos(angle), 30 * std::sin(angle)};
    DrawLine({middle.x - half.x, middle.y - half.y}, {middle.x + half.x, middle.y + half.y}, kWhite,
             3, 1, &image);
    const Light light(image);
    EXPECT_NEAR(light.area, 60 * 3 + std::numbers::pi * 1.5 * 1.5, 2) << angle;
    EXPECT_NEAR(light.u, middle.x, 0.05);
    EXPECT_NEAR(light.v, middle.y, 0.05);
  }
}

TEST(DrawTest, OpacityScalesTheLight) {
  Image full(40, 40), half(40, 40);
  DrawLine({5, 20}, {35, 20}, kWhite, 2, 1, &full);
  DrawLine({5, 20}, {35, 20}, kWhite, 2, 0.5, &half);
  EXPECT_NEAR(Light(half).area, 0.5 * Light(full).area, 0.5);
}

TEST(DrawTest, WhatLiesOutsideIsCutOff) {
  Image image(20, 10);
  DrawLine({-1e9, 5}, {1e9, 5}, kWhite, 1, 1, &image);
  EXPECT_NEAR(Light(image).area, 20, 0.5);
  const Image before = image;
  DrawLine({-50, -50}, {-5, 80}, kWhite, 3, 1, &image);
  DrawLine({std::nan(""), 0}, {5, 5}, kWhite, 3, 1, &image);
  DrawDot({100, 100}, 5, kWhite, &image);
  DrawText({-500, -500}, "17", kWhite, 10, &image);
  DrawText({1e300, 0}, "17", kWhite, 10, &image);
  EXPECT_EQ(image.bgr, before.bgr);
}

TEST(DrawTest, BoxIsHollow) {
  Image image(60, 60);
  DrawBox({10, 12, 30, 20}, {10, 20, 200}, 1, &image);
  const auto red = [&](int u, int v) { return image.Row(v)[3 * u + 2]; };
  EXPECT_EQ(red(10, 20), 200);
  EXPECT_EQ(red(40, 20), 200);
  EXPECT_EQ(red(25, 12), 200);
  EXPECT_EQ(red(25, 32), 200);
  EXPECT_EQ(red(25, 22), 0);
  EXPECT_EQ(red(43, 22), 0);
}

TEST(DrawTest, TrailFadesTowardsTheOldest) {
  Image image(120, 20);
  std::vector<Vec2d> points;
  for (int k = 0; k <= 10; ++k) points.push_back({10.0 + 10 * k, 10});
  DrawTrail(points, kWhite, 2, &image);
  EXPECT_LT(image.Row(10)[3 * 15], 60);
  EXPECT_NEAR(image.Row(10)[3 * 55], 128, 30);
  EXPECT_GT(image.Row(10)[3 * 105], 240);
  DrawTrail(std::span(points).first(1), kWhite, 2, &image);
  DrawTrail({}, kWhite, 2, &image);
}

TEST(DrawTest, TextStandsOnItsLowerLeftCorner) {
  Image image(80, 40);
  DrawText({10, 30}, "H", kWhite, 14, &image);
  int left = 80, top = 40, bottom = 0;
  for (int v = 0; v < 40; ++v) {
    for (int u = 0; u < 80; ++u) {
      if (image.Row(v)[3 * u] < 128) continue;
      left = std::min(left, u);
      top = std::min(top, v);
      bottom = std::max(bottom, v);
    }
  }
  EXPECT_NEAR(left, 12, 2);
  EXPECT_NEAR(bottom, 30, 1);
  EXPECT_NEAR(top, 30 - 14, 2);
}

TEST(DrawTest, ColoursAreBrightStableAndDistinct) {
  EXPECT_EQ(ColorOfId(5), ColorOfId(5));
  std::set<std::array<int, 3>> seen;
  for (Id id = 1; id <= 40; ++id) {
    const Color c = ColorOfId(id), next = ColorOfId(id + 1);
    EXPECT_GE(std::max({c.blue, c.green, c.red}), 160);
    EXPECT_GT(
        std::abs(c.blue - next.blue) + std::abs(c.green - next.green) + std::abs(c.red - next.red),
        100);
    seen.insert({c.blue, c.green, c.red});
  }
  EXPECT_EQ(seen.size(), 40U);
}

}  // namespace
}  // namespace flocklift
