// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/media/turned.h"

#include <gtest/gtest.h>

#include <utility>

namespace flocklift {
namespace {

// Each pixel another, by its place.
Image Numbered(int width, int height) {
  Image image(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) image.Row(v)[3 * u] = static_cast<std::uint8_t>(10 * v + u);
  }
  return image;
}

TEST(Turned, QuartersGoClockwise) {
  const Image image = Numbered(3, 2);
  const Image once = Turned(image, 1);
  EXPECT_EQ(std::pair(once.width, once.height), std::pair(2, 3));
  EXPECT_EQ(once.Row(0)[3], image.Row(0)[0]);  // from the upper left to the upper right
  EXPECT_EQ(once.Row(0)[0], image.Row(1)[0]);
  for (int quarters = 0; quarters < 4; ++quarters) {
    EXPECT_EQ(Turned(Turned(image, quarters), (4 - quarters) % 4).bgr, image.bgr) << quarters;
  }
}

TEST(Turned, OrientationsOfExif) {
  const Image image = Numbered(3, 2);
  // Where the picture's first row and first column lie: Exif 2.32, table 6.
  EXPECT_EQ(Upright(image, 1).bgr, image.bgr);
  EXPECT_EQ(Upright(image, 2).Row(0)[0], image.Row(0)[6]);  // row 0 at the top, column 0 right
  EXPECT_EQ(Upright(image, 3).Row(0)[0], image.Row(1)[6]);
  EXPECT_EQ(Upright(image, 4).Row(0)[0], image.Row(1)[0]);
  const Image transposed = Upright(image, 5);  // row 0 left, column 0 at the top
  for (int v = 0; v < 2; ++v) {
    for (int u = 0; u < 3; ++u) EXPECT_EQ(transposed.Row(u)[3 * v], image.Row(v)[3 * u]);
  }
  EXPECT_EQ(Upright(image, 6).bgr, Turned(image, 1).bgr);
  EXPECT_EQ(Upright(image, 7).Row(0)[0], image.Row(1)[6]);
  EXPECT_EQ(Upright(image, 8).bgr, Turned(image, 3).bgr);
  EXPECT_EQ(Upright(image, 0).bgr, image.bgr);
}

}  // namespace
}  // namespace flocklift
