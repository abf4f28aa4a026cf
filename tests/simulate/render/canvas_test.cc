// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/canvas.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

constexpr int kSize = 24;
constexpr int kGround = 160;  // grey level of the background

Canvas Grey() {
  Canvas canvas(kSize, kSize);
  for (int v = 0; v < kSize; ++v) std::fill_n(canvas.Row(v), 3 * kSize, kGround * Canvas::kUnit);
  return canvas;
}

Paint Tone(int level, double depth, double opacity = 1) {
  const std::int32_t tone = level * Canvas::kUnit;
  return {{tone, tone, tone}, depth, opacity};
}

CoverageMask Square(double left, double top, double side) {
  CoverageMask mask({left, top, side, side}, kSize, kSize);
  Silhouette square;
  square.trapezoids.push_back({top, top + side, left, left, left + side, left + side});
  mask.Add(square, 1);
  mask.Finish();
  return mask;
}

// Blue of every pixel.
std::vector<int> Developed(Canvas* canvas) {
  std::vector<int> pixels;
  std::vector<std::uint8_t> row(3 * kSize);
  for (int v = 0; v < kSize; ++v) {
    canvas->Develop(v, nullptr, row.data());
    for (int u = 0; u < kSize; ++u) pixels.push_back(row[3 * static_cast<std::size_t>(u)]);
  }
  return pixels;
}

// A wall at depth 10 over the pixels left of x = `edge`, of tone 60.
void DrawWall(double edge, DepthBuffer* buffer) {
  const auto corner = [](double x, double y) { return ImageCorner{{x, y}, 0.1, 1}; };
  buffer->Draw({corner(-9, -9), corner(edge, -9), corner(edge, 99)}, {60, 60, 60});
  buffer->Draw({corner(-9, -9), corner(edge, 99), corner(-9, 99)}, {60, 60, 60});
}

constexpr std::size_t At(int u, int v) { return static_cast<std::size_t>(kSize * v + u); }

TEST(CanvasTest, AWallHidesWhatIsBehindItAndNotWhatIsInFront) {
  DepthBuffer wall(kSize, kSize);
  DrawWall(11.5, &wall);
  for (const double depth : {5.0, 20.0}) {
    Canvas canvas = Grey();
    canvas.Place(&wall, 0);
    canvas.LayOver(Square(4, 4, 16), Tone(200, depth));
    const std::vector<int> picture = Developed(&canvas);
    EXPECT_EQ(picture[At(8, 12)], depth < 10 ? 200 : 60);
    EXPECT_EQ(picture[At(16, 12)], 200);
    EXPECT_EQ(picture[At(8, 1)], 60);
    EXPECT_EQ(picture[At(16, 1)], kGround);
  }
}

TEST(CanvasTest, TheEdgeOfAWallMixesWhatTheSamplesSee) {
  DepthBuffer wall(kSize, kSize);
  DrawWall(12, &wall);  // through the middle of column 12: two of four samples
  Canvas behind = Grey(), in_front = Grey(), empty = Grey();
  for (Canvas* canvas : {&behind, &in_front, &empty}) canvas->Place(&wall, 0);
  behind.LayOver(Square(4, 4, 16), Tone(200, 20));
  in_front.LayOver(Square(4, 4, 16), Tone(200, 5));
  EXPECT_EQ(Developed(&empty)[At(12, 12)], (60 + kGround) / 2);
  EXPECT_EQ(Developed(&behind)[At(12, 12)], (60 + 200) / 2);
  EXPECT_EQ(Developed(&in_front)[At(12, 12)], 200);
}

TEST(CanvasTest, HazeFadesAWallIntoTheBackground) {
  DepthBuffer wall(kSize, kSize);
  DrawWall(30, &wall);
  Canvas canvas = Grey();
  canvas.Place(&wall, 20);
  EXPECT_NEAR(Developed(&canvas)[At(3, 3)], kGround + std::exp(-0.5) * (60 - kGround), 0.6);
}

TEST(CanvasTest, OpacityIsAShare) {
  Canvas canvas = Grey();
  canvas.LayOver(Square(4, 4, 16), Tone(60, 5, 0.25));
  EXPECT_EQ(Developed(&canvas)[At(12, 12)], kGround - 25);
}

TEST(CanvasTest, ADabDarkensItsAreaAtItsPlace) {
  for (const double area : {0.5, 0.03, 0.0004}) {
    double sum = 0, x = 0, y = 0;
    const Vec2d place{11.3, 12.8};
    const int dabs = static_cast<int>(2 / area);  // so that there is something to sum
    std::uint32_t grain = 5;
    std::vector<double> dark(kSize * kSize);
    for (int k = 0; k < dabs; ++k, grain += 4) {
      Canvas canvas(kSize, kSize);
      if (k > 400) break;
      for (int v = 0; v < kSize; ++v) {
        std::fill_n(canvas.Row(v), 3 * kSize, kGround * Canvas::kUnit);
      }
      canvas.Dab(place, area, Tone(0, 5), grain);
      for (int v = 10; v < 16; ++v) {
        for (int u = 9; u < 15; ++u) {
          const double d = kGround - static_cast<double>(canvas.Row(v)[3 * u]) / Canvas::kUnit;
          sum += d;
          x += d * u;
          y += d * v;
        }
      }
    }
    const int drawn = std::min(dabs, 401);
    EXPECT_NEAR(sum / (drawn * area * kGround), 1, 0.03) << area;
    EXPECT_NEAR(x / sum, place.x, 0.03) << area;
    EXPECT_NEAR(y / sum, place.y, 0.03) << area;
  }
}

TEST(CanvasTest, ADabAcrossTheBorderIsCutOff) {
  Canvas canvas = Grey();
  for (const Vec2d& place : {Vec2d{-0.5, 3}, Vec2d{23.5, 23.5}, Vec2d{-5, 3}, Vec2d{3, 40}}) {
    canvas.Dab(place, 0.8, Tone(0, 5), 1);
  }
  const std::vector<int> picture = Developed(&canvas);
  EXPECT_LT(picture[At(0, 3)], kGround);
  EXPECT_LT(picture[At(23, 23)], kGround);
  EXPECT_EQ(std::count(picture.begin(), picture.end(), kGround), kSize * kSize - 2);
}

TEST(CanvasTest, ADabIsHiddenLikeAPatch) {
  DepthBuffer wall(kSize, kSize);
  DrawWall(30, &wall);
  Canvas canvas = Grey();
  canvas.Place(&wall, 0);
  canvas.Dab({5, 5}, 1, Tone(0, 20), 1);
  canvas.Dab({15, 15}, 1, Tone(0, 5), 1);
  const std::vector<int> picture = Developed(&canvas);
  EXPECT_EQ(picture[At(5, 5)], 60);
  EXPECT_LE(picture[At(15, 15)], 1);
}

}  // namespace
}  // namespace flocklift
