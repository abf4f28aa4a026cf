// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/patch_blobs.h"

#include <gtest/gtest.h>

#include "tests/track/pictures.h"

namespace flocklift {
namespace {

constexpr int kWidth = 60, kHeight = 40;

// A flat sky of 200, and what is found in the patch of all pixels darker than 190.
BlobFrame Cut(const GrayImage& image, const BlobLimits& limits) {
  LocalBackground background;
  background.width = background.height = 1;
  background.step = kWidth;
  background.level = {200};
  background.noise = {1};
  const LevelTable level(background, kWidth, kHeight);
  GrayImage mask(kWidth, kHeight);
  for (std::size_t k = 0; k < mask.pixels.size(); ++k) {
    mask.pixels[k] = image.pixels[k] < 190 ? 255 : 0;
  }
  BlobFrame found;
  PatchCutter cutter;
  for (const Component& c : FindComponents(mask)) {
    cutter.Append(c, {image, image, level, 1}, limits, &found);
  }
  return found;
}

GrayImage Sky200() { return DrawPicture(kWidth, kHeight, {.level = 200}, {}); }

TEST(PatchBlobsTest, SumsByHand) {
  GrayImage image = Sky200();
  image.Row(10)[20] = 150;  // contrasts 50, 100 and 50
  image.Row(10)[21] = 100;
  image.Row(11)[21] = 150;
  const BlobFrame found = Cut(image, {.least_peak = 20});
  ASSERT_EQ(found.blobs.size(), 1u);
  const Blob& blob = found.blobs[0];
  EXPECT_DOUBLE_EQ(blob.mass, 200);
  EXPECT_NEAR(blob.center.x, 20.75, 1e-9);
  EXPECT_NEAR(blob.center.y, 10.25, 1e-9);
  EXPECT_NEAR(blob.moments.xx, 0.1875 + 1.0 / 12, 1e-9);
  EXPECT_NEAR(blob.moments.yy, 0.1875 + 1.0 / 12, 1e-9);
  EXPECT_NEAR(blob.moments.xy, 0.0625, 1e-9);
  EXPECT_EQ(blob.peak, 100);
  // Ends at a contrast of 30: 0.6 of a pixel before 50, 0.3 before 100.
  EXPECT_NEAR(blob.box.left, 19.6, 1e-6);
  EXPECT_NEAR(blob.box.top, 9.3, 1e-6);
  EXPECT_NEAR(blob.box.width, 2.1, 1e-6);
  EXPECT_NEAR(blob.box.height, 2.1, 1e-6);
  EXPECT_FALSE(blob.cut);
  EXPECT_FALSE(blob.edges.any());
  EXPECT_EQ(blob.pixel_count, 3u);
}

TEST(PatchBlobsTest, LimitsAreKept) {
  GrayImage image = Sky200();
  image.Row(10)[20] = image.Row(10)[21] = image.Row(10)[22] = 150;
  EXPECT_EQ(Cut(image, {.least_peak = 50}).blobs.size(), 1u);
  EXPECT_EQ(Cut(image, {.least_peak = 51}).blobs.size(), 0u);
  EXPECT_EQ(Cut(image, {.min_area = 3}).blobs.size(), 1u);
  const BlobFrame none = Cut(image, {.min_area = 4});
  EXPECT_EQ(none.blobs.size(), 0u);
  EXPECT_EQ(none.pixels.size(), 0u);
  EXPECT_EQ(Cut(image, {.longest_side = 3}).blobs.size(), 1u);
  EXPECT_EQ(Cut(image, {.longest_side = 2.5}).blobs.size(), 0u);
}

TEST(PatchBlobsTest, TwoThatTouchAreCutAndShareThePixels) {
  const GrayImage image =
      DrawPicture(kWidth, kHeight, {.level = 200},
                  {{.center = {20, 15}, .contrast = -120}, {.center = {27, 15}, .contrast = -120}});
  const BlobFrame found = Cut(image, {.least_peak = 20});
  ASSERT_EQ(found.blobs.size(), 2u);
  EXPECT_TRUE(found.blobs[0].cut);
  EXPECT_NEAR(found.blobs[0].center.x + found.blobs[1].center.x, 47, 0.1);
  EXPECT_EQ(found.blobs[0].pixel_count + found.blobs[1].pixel_count, found.pixels.size());
  EXPECT_EQ(found.blobs[1].first_pixel, found.blobs[0].pixel_count);
}

TEST(PatchBlobsTest, EdgesThatCutAreNamed) {
  GrayImage image = Sky200();
  image.Row(0)[0] = image.Row(0)[1] = image.Row(1)[0] = 100;
  const BlobFrame found = Cut(image, {.least_peak = 20});
  ASSERT_EQ(found.blobs.size(), 1u);
  EXPECT_TRUE(found.blobs[0].edges.left);
  EXPECT_TRUE(found.blobs[0].edges.top);
  EXPECT_FALSE(found.blobs[0].edges.right);
  EXPECT_FALSE(found.blobs[0].edges.bottom);
}

}  // namespace
}  // namespace flocklift
