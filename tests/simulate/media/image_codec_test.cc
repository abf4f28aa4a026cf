// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/media/image_codec.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
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

std::vector<std::uint8_t> EncodedByOpenCv(const std::string& extension, const cv::Mat& picture,
                                          const std::vector<int>& settings = {}) {
  std::vector<std::uint8_t> bytes;
  EXPECT_TRUE(cv::imencode(extension, picture, bytes, settings)) << extension;
  return bytes;
}

// The mean difference to what OpenCV reads.
double FromOpenCv(const std::vector<std::uint8_t>& bytes) {
  const cv::Mat theirs = cv::imdecode(bytes, cv::IMREAD_COLOR);
  const auto ours = DecodeImage(bytes);
  if (!ours || ours->width != theirs.cols || ours->height != theirs.rows) return HUGE_VAL;
  double sum = 0;
  for (int v = 0; v < theirs.rows; ++v) {
    for (int k = 0; k < 3 * theirs.cols; ++k) sum += std::abs(ours->Row(v)[k] - theirs.ptr(v)[k]);
  }
  return sum / (3.0 * theirs.rows * theirs.cols);
}

cv::Mat AsMat(const Image& image) {
  return cv::Mat(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.bgr.data()))
      .clone();
}

TEST(ImageCodecTest, FormatsOfOthersAreReadAsOpenCvDoes) {
  const cv::Mat color = AsMat(Gradient(37, 23));
  for (const char* extension : {".png", ".bmp", ".tiff", ".ppm"}) {
    EXPECT_EQ(FromOpenCv(EncodedByOpenCv(extension, color)), 0) << extension;
  }
  EXPECT_LT(FromOpenCv(EncodedByOpenCv(".webp", color, {cv::IMWRITE_WEBP_QUALITY, 101})), 1);
  EXPECT_LT(FromOpenCv(EncodedByOpenCv(".jpg", color, {cv::IMWRITE_JPEG_QUALITY, 95})), 1.5);
  cv::Mat gray, deep(23, 37, CV_16UC1);
  cv::extractChannel(color, gray, 0);
  gray.convertTo(deep, CV_16U, 257);
  for (const char* extension : {".png", ".bmp", ".tiff", ".pgm", ".jpg"}) {
    EXPECT_LT(FromOpenCv(EncodedByOpenCv(extension, gray)), 0.5) << extension;
  }
  EXPECT_EQ(FromOpenCv(EncodedByOpenCv(".png", gray)), 0);
  EXPECT_LT(FromOpenCv(EncodedByOpenCv(".png", deep)), 1);
  const cv::Mat see_through(5, 7, CV_8UC4, cv::Scalar(10, 100, 200, 90));
  EXPECT_EQ(FromOpenCv(EncodedByOpenCv(".png", see_through)), 0);
}

// A JPEG with an Exif block of one entry, the orientation.
TEST(ImageCodecTest, ExifTurnsAPictureUpright) {
  const std::vector<std::uint8_t> jpeg = EncodeJpeg(Gradient(64, 48), 95);
  for (std::uint8_t orientation = 1; orientation <= 8; ++orientation) {
    const std::vector<std::uint8_t> exif = {0xff, 0xe1, 0, 34, 'E', 'x', 'i', 'f', 0, 0,
                                            'M',  'M',  0, 42, 0,   0,   0,   8,  // header
                                            0,    1,                              // entries
                                            1,    0x12, 0, 3,  0,   0,   0,   1,   0, orientation,
                                            0,    0,  // a short
                                            0,    0,    0, 0};
    std::vector<std::uint8_t> turned = jpeg;
    turned.insert(turned.begin() + 2, exif.begin(), exif.end());
    const auto image = DecodeImage(turned);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->width, orientation < 5 ? 64 : 48);
    EXPECT_LT(FromOpenCv(turned), 1.5) << int{orientation};
  }
}

TEST(ImageCodecTest, EncodedSizesAreThoseOfOpenCv) {
  Image image = Gradient(320, 240);
  for (std::size_t k = 0; k < image.bgr.size(); ++k) {
    image.bgr[k] = static_cast<std::uint8_t>(image.bgr[k] / 2 + (k * 2654435761u >> 26) % 16);
  }
  EXPECT_LT(EncodePng(image).size(), 1.2 * EncodedByOpenCv(".png", AsMat(image)).size());
  for (const int quality : {50, 84, 90}) {
    const auto theirs = static_cast<double>(
        EncodedByOpenCv(".jpg", AsMat(image), {cv::IMWRITE_JPEG_QUALITY, quality}).size());
    const auto ours = static_cast<double>(EncodeJpeg(image, quality).size());
    EXPECT_LT(ours, 1.4 * theirs) << quality;
    EXPECT_GT(ours, 0.6 * theirs) << quality;
  }
}

TEST(ImageCodecTest, WhatIsNoPictureDecodesToNothing) {
  EXPECT_FALSE(DecodeImage({}));
  EXPECT_FALSE(DecodeImage(std::vector<std::uint8_t>{1, 2, 3, 4}));
  for (const auto& whole : {EncodePng(Gradient(64, 48)), EncodeJpeg(Gradient(64, 48))}) {
    EXPECT_FALSE(DecodeImage({whole.data(), 20}));
    EXPECT_FALSE(DecodeImage({whole.data(), whole.size() / 2})) << int{whole[0]};
  }
  EXPECT_THROW(EncodePng(Image()), std::invalid_argument);
}

TEST(ImageCodecTest, Files) {
  const auto path = std::filesystem::path(::testing::TempDir()) /
                    ("flocklift_image_codec_" + std::to_string(::getpid()) + ".png");
  WritePng(path, Gradient(20, 10));
  EXPECT_EQ(ReadImage(path).bgr, Gradient(20, 10).bgr);
  EXPECT_TRUE(IsImageFile(path));
  std::ofstream(path) << "no picture";
  EXPECT_FALSE(IsImageFile(path));
  EXPECT_THROW(ReadImage(path), InputError);
  std::filesystem::remove(path);
  EXPECT_THROW(ReadImage(path), InputError);
}

}  // namespace
}  // namespace flocklift
