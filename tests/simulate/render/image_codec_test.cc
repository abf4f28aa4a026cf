// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/image_codec.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

Image Gradient(int width, int height) {
  Image image(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      image.Row(v)[3 * u] = static_cast<std::uint8_t>(3 * u);
      image.Row(v)[3 * u + 1] = static_cast<std::uint8_t>(5 * v);
      image.Row(v)[3 * u + 2] = static_cast<std::uint8_t>(u + v);
    }
  }
  return image;
}

TEST(ImageCodecTest, PngKeepsEveryPixel) {
  const Image image = Gradient(37, 23);
  const auto back = DecodeImage(EncodePng(image));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->width, 37);
  EXPECT_EQ(back->height, 23);
  EXPECT_EQ(back->bgr, image.bgr);
}

TEST(ImageCodecTest, JpegComesNear) {
  const Image image = Gradient(64, 48);
  const auto back = DecodeImage(EncodeJpeg(image, 95));
  ASSERT_TRUE(back);
  double sum = 0;
  for (std::size_t k = 0; k < image.bgr.size(); ++k) sum += std::abs(image.bgr[k] - back->bgr[k]);
  EXPECT_LT(sum / static_cast<double>(image.bgr.size()), 4);
}

TEST(ImageCodecTest, WhatIsNoPictureDecodesToNothing) {
  EXPECT_FALSE(DecodeImage({}));
  EXPECT_FALSE(DecodeImage(std::vector<std::uint8_t>{1, 2, 3, 4}));
  std::vector<std::uint8_t> cut = EncodePng(Gradient(64, 48));
  cut.resize(20);
  EXPECT_FALSE(DecodeImage(cut));
  EXPECT_THROW(EncodePng(Image()), std::invalid_argument);
}

TEST(ImageCodecTest, Files) {
  const auto path = std::filesystem::path(::testing::TempDir()) /
                    ("flocklift_image_codec_" + std::to_string(::getpid()) + ".png");
  WritePng(path, Gradient(20, 10));
  EXPECT_EQ(ReadImage(path).bgr, Gradient(20, 10).bgr);
  std::ofstream(path) << "no picture";
  EXPECT_THROW(ReadImage(path), InputError);
  std::filesystem::remove(path);
  EXPECT_THROW(ReadImage(path), InputError);
}

}  // namespace
}  // namespace flocklift
