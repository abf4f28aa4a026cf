// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/background.h"

#include <gtest/gtest.h>

#include <utility>

#include "tests/track/pictures.h"

namespace flocklift {
namespace {

std::vector<SoftBlob> ScatteredBlobs(int width, int height, int count) {
  std::vector<SoftBlob> blobs;
  Rng rng(7);
  for (int k = 0; k < count; ++k) {
    blobs.push_back({.center = {rng.Uniform(0, width), rng.Uniform(0, height)}});
  }
  return blobs;
}

TEST(BackgroundTest, LevelIgnoresTheAnimals) {
  const Sky sky{.level = 120, .gradient_x = 0.03, .gradient_y = 0.08, .noise = 2};
  const auto blobs = ScatteredBlobs(640, 480, 60);
  const LocalBackground background =
      EstimateBackground(DrawPicture(640, 480, sky, blobs), 60, 0.7, 2);
  for (int v = 40; v < 440; v += 13) {
    for (int u = 40; u < 600; u += 13) {
      EXPECT_NEAR(background.LevelAt(u, v), 120 + 0.03 * u + 0.08 * v, 0.8) << u << ' ' << v;
    }
  }
  for (const SoftBlob& b : blobs) {
    EXPECT_NEAR(background.LevelAt(b.center.x, b.center.y),
                120 + 0.03 * b.center.x + 0.08 * b.center.y, 3.0);
  }
}

TEST(BackgroundTest, NoiseIsThatOfTheSky) {
  for (const double noise : {2.0, 5.0}) {
    const Sky sky{.level = 120, .noise = noise};
    const LocalBackground background =
        EstimateBackground(DrawPicture(640, 480, sky, ScatteredBlobs(640, 480, 60)), 60, 0.7, 2);
    for (int v = 20; v < 480; v += 50) {
      for (int u = 20; u < 640; u += 50) {
        EXPECT_NEAR(background.NoiseAt(u, v), noise, 0.2 * noise);
      }
    }
  }
}

TEST(BackgroundTest, NoiseHasAFloor) {
  const LocalBackground background =
      EstimateBackground(DrawPicture(320, 240, {.level = 100}, {}), 40, 0.7, 2);
  EXPECT_FLOAT_EQ(static_cast<float>(background.NoiseAt(100, 100)), 0.7f);
}

TEST(BackgroundTest, TheTableHoldsTheLevelOfEveryPixel) {
  const Sky sky{.level = 120, .gradient_x = 0.2, .gradient_y = -0.1, .noise = 3};
  for (const auto& [width, height] : {std::pair{250, 241}, {7, 3}, {1, 1}}) {
    const LocalBackground background =
        EstimateBackground(DrawPicture(width, height, sky, {}), 40, 0.7, 2);
    const LevelTable table(background, width, height);
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        ASSERT_NEAR(table.At(u, v), background.LevelAt(u, v), 1e-3) << u << ' ' << v;
      }
    }
  }
}

TEST(BackgroundTest, TinyPicturesHaveABackground) {
  for (const int size : {1, 2, 3, 7, 31}) {
    const LocalBackground background =
        EstimateBackground(DrawPicture(size, size, {.level = 100}, {}), 40, 0.7, 2);
    EXPECT_NEAR(background.LevelAt(0, 0), 100, 0.6) << size;
  }
}

}  // namespace
}  // namespace flocklift
