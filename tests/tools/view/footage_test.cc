// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Frame-exactness: each frame of the test's film shows its own number, as bright and dark fields.

#include "tools/view/footage.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <span>

#include "simulate/core/check.h"
#include "simulate/core/rng.h"
#include "simulate/media/image_codec.h"
#include "simulate/media/video_writer.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

constexpr int kBits = 10, kField = 16, kFrames = 150;

Image FrameOf(int number) {
  Image image(kBits * kField, 64);
  for (int bit = 0; bit < kBits; ++bit) {
    const std::uint8_t level = (number >> bit & 1) != 0 ? 230 : 20;
    for (int v = 0; v < 64; ++v) {
      std::fill_n(image.Row(v) + 3 * bit * kField, 3 * kField, level);
    }
  }
  return image;
}

int NumberIn(const std::string& jpeg) {
  const auto image =
      DecodeImage(std::span(reinterpret_cast<const std::uint8_t*>(jpeg.data()), jpeg.size()));
  if (!image) return -1;
  int number = 0;
  for (int bit = 0; bit < kBits; ++bit) {
    const int u = (2 * bit + 1) * image->width / (2 * kBits);
    if (image->Row(image->height / 2)[3 * u] > 128) number |= 1 << bit;
  }
  return number;
}

class FootageTest : public testing::Test {
 protected:
  void SetUp() override {
    path_ = fs::path(testing::TempDir()) /
            (std::string("footage_test_") +
             testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  void TearDown() override { fs::remove_all(path_); }

  fs::path path_;
};

TEST_F(FootageTest, AnyFrameIsThatFrame) {
  const fs::path video = path_ / "video.mp4";
  {
    VideoWriter writer(video, kBits * kField, 64, 30, {});
    for (int f = 1; f <= kFrames; ++f) writer.Write(FrameOf(f));
    writer.Finish();
  }
  Footage footage(video);
  EXPECT_EQ(footage.width(), kBits * kField);
  EXPECT_EQ(footage.frame_count(), kFrames);
  EXPECT_EQ(footage.file(), video);
  for (const int f : {1, 150, 2, 61, 60, 59, 120, 121, 119, 149, 1}) {
    EXPECT_EQ(NumberIn(footage.Jpeg(f, 4000)), f);
  }
  for (int f = 30; f <= 70; ++f) EXPECT_EQ(NumberIn(footage.Jpeg(f, 4000)), f);
  Rng rng(5);
  for (int k = 0; k < 60; ++k) {
    const int f = static_cast<int>(rng.Uniform(1, kFrames + 1));
    EXPECT_EQ(NumberIn(footage.Jpeg(f, 80)), f);
  }
  for (const int f : {0, -1, kFrames + 1, 1 << 30}) EXPECT_TRUE(footage.Jpeg(f, 4000).empty()) << f;
}

TEST_F(FootageTest, PicturesAreFootageToo) {
  for (int f = 1; f <= 12; ++f) {
    WritePng(path_ / ("img_" + std::to_string(f) + ".png"), FrameOf(f));
  }
  Footage footage(path_);
  EXPECT_EQ(footage.frame_count(), 12);
  EXPECT_TRUE(footage.file().empty());
  for (const int f : {12, 1, 10, 2}) EXPECT_EQ(NumberIn(footage.Jpeg(f, 64)), f);
}

TEST_F(FootageTest, WhatIsNoFootageIsRefused) {
  EXPECT_THROW(Footage(path_ / "nothing.mp4"), InputError);
  const fs::path text = path_ / "passwd";
  fs::copy_file("/etc/passwd", text);
  EXPECT_THROW(Footage{text}, InputError);
}

}  // namespace
}  // namespace flocklift
