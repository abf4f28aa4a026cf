// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/video_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

class VideoSourceTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              (std::string("video_source_") +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  // An even grey picture.
  void WritePicture(const std::string& name, int gray, int width = 16, int height = 12) {
    cv::imwrite((folder_ / name).string(), cv::Mat(height, width, CV_8UC1, cv::Scalar(gray)));
  }

  std::vector<int> GraysOf(const fs::path& path) {
    VideoSource source(path);
    std::vector<int> grays;
    GrayImage image;
    while (source.Read(&image)) grays.push_back(image.pixels[0]);
    return grays;
  }

  std::string ErrorOf(const fs::path& path) {
    try {
      GraysOf(path);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("\n")));
      return error.what();
    }
    return "no error";
  }

  fs::path folder_;
};

TEST_F(VideoSourceTest, FolderInNaturalOrder) {
  WritePicture("img_10.png", 30);
  WritePicture("img_9.png", 20);
  WritePicture("img_1.png", 10);
  std::ofstream(folder_ / "notes.txt") << "no picture";
  EXPECT_EQ(GraysOf(folder_), (std::vector<int>{10, 20, 30}));
  const VideoSource source(folder_);
  EXPECT_EQ(source.width(), 16);
  EXPECT_EQ(source.height(), 12);
  EXPECT_EQ(source.frame_count(), 3);
  EXPECT_EQ(source.fps(), std::nullopt);
}

TEST_F(VideoSourceTest, Pattern) {
  WritePicture("img_0010.png", 30);
  WritePicture("img_0009.png", 20);
  WritePicture("other_0001.png", 99);
  WritePicture("img_01.png", 98);  // too few digits
  EXPECT_EQ(GraysOf(folder_ / "img_%04d.png"), (std::vector<int>{20, 30}));
  EXPECT_EQ(GraysOf(folder_ / "img_%d.png"), (std::vector<int>{98, 20, 30}));
}

TEST_F(VideoSourceTest, ColourAndGrayAgree) {
  cv::Mat picture(4, 6, CV_8UC3, cv::Scalar(10, 100, 200));
  cv::imwrite((folder_ / "a.png").string(), picture);
  VideoSource colour(folder_), gray(folder_);
  Image image;
  GrayImage luma;
  ASSERT_TRUE(colour.Read(&image));
  ASSERT_TRUE(gray.Read(&luma));
  EXPECT_FALSE(colour.Read(&image));
  EXPECT_EQ(image.bgr[0], 10);
  EXPECT_EQ(image.bgr[1], 100);
  EXPECT_EQ(image.bgr[2], 200);
  EXPECT_NEAR(luma.pixels[0], 0.114 * 10 + 0.587 * 100 + 0.299 * 200, 1);
}

TEST_F(VideoSourceTest, VideoFile) {
  const fs::path path = folder_ / "film.avi";
  {
    cv::VideoWriter writer(path.string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25,
                           cv::Size(64, 48));
    ASSERT_TRUE(writer.isOpened());
    for (int k = 0; k < 5; ++k) writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(40 * k)));
  }
  const VideoSource source(path);
  EXPECT_EQ(source.fps(), 25.0);
  EXPECT_EQ(source.frame_count(), 5);
  const std::vector<int> grays = GraysOf(path);
  ASSERT_EQ(grays.size(), 5u);
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(grays[k], 40 * k, 3);

  for (const int passed : {0, 1, 3}) {
    VideoSource skipping(path);
    ASSERT_TRUE(skipping.Skip(passed));
    GrayImage image;
    ASSERT_TRUE(skipping.Read(&image));
    EXPECT_NEAR(image.pixels[0], 40 * passed, 3);
  }
  EXPECT_FALSE(VideoSource(path).Skip(6));
}

// Full range (Motion JPEG) and limited range (MPEG-4), which is spread.
TEST_F(VideoSourceTest, LumaIsThatOfTheColours) {
  for (const auto& [name, codec] : {std::pair{"full.avi", "MJPG"}, {"limited.mp4", "mp4v"}}) {
    const fs::path path = folder_ / name;
    {
      cv::VideoWriter writer(path.string(),
                             cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]), 25,
                             cv::Size(64, 48));
      ASSERT_TRUE(writer.isOpened());
      for (int k = 0; k < 4; ++k) {
        cv::Mat picture(48, 64, CV_8UC3);
        for (int u = 0; u < 64; ++u) picture.col(u) = cv::Scalar::all(4 * u - 2 * k + 6);
        writer.write(picture);
      }
    }
    VideoSource in_color(path), as_luma(path);
    Image color;
    GrayImage luma;
    int frames = 0;
    for (; in_color.Read(&color); ++frames) {
      ASSERT_TRUE(as_luma.Read(&luma));
      for (int u = 0; u < 64; ++u) {
        const auto* bgr = color.bgr.data() + static_cast<std::size_t>(3 * (24 * 64 + u));
        const double gray = 0.114 * bgr[0] + 0.587 * bgr[1] + 0.299 * bgr[2];
        EXPECT_NEAR(luma.Row(24)[u], gray, 2.5) << name << ' ' << u;
      }
    }
    EXPECT_EQ(frames, 4);
    EXPECT_FALSE(as_luma.Read(&luma));
  }
}

TEST_F(VideoSourceTest, PicturesArePassedOver) {
  for (int k = 1; k <= 4; ++k) WritePicture("p" + std::to_string(k) + ".png", 10 * k);
  VideoSource source(folder_);
  ASSERT_TRUE(source.Skip(2));
  GrayImage image;
  ASSERT_TRUE(source.Read(&image));
  EXPECT_EQ(image.pixels[0], 30);
  EXPECT_TRUE(source.Skip(1));
  EXPECT_FALSE(source.Read(&image));
  EXPECT_FALSE(source.Skip(1));
}

TEST_F(VideoSourceTest, Faults) {
  EXPECT_THAT(ErrorOf(folder_ / "none.mp4"), testing::HasSubstr("no such file"));
  EXPECT_THAT(ErrorOf(folder_), testing::HasSubstr("no picture"));
  EXPECT_THAT(ErrorOf(folder_ / "img_%04d.png"), testing::HasSubstr("no file matches"));
  std::ofstream(folder_ / "empty.mp4").flush();
  EXPECT_THAT(ErrorOf(folder_ / "empty.mp4"), testing::HasSubstr("empty"));
  std::ofstream(folder_ / "text.mp4") << "this is text, and text is no film";
  EXPECT_THAT(ErrorOf(folder_ / "text.mp4"), testing::HasSubstr("no video"));
  WritePicture("p1.png", 10);
  EXPECT_THAT(ErrorOf(folder_ / "p1.png"), testing::HasSubstr("one picture"));
  WritePicture("p2.png", 10, 20, 12);
  EXPECT_THAT(ErrorOf(folder_ / "p%d.png"), testing::HasSubstr("20 x 12"));
  std::ofstream(folder_ / "p0.png") << "garbage";
  EXPECT_THAT(ErrorOf(folder_ / "p%d.png"), testing::HasSubstr("p0.png: the picture cannot"));
}

TEST(NaturalLessTest, NumbersCountAsNumbers) {
  EXPECT_TRUE(NaturalLess("a9", "a10"));
  EXPECT_FALSE(NaturalLess("a10", "a9"));
  EXPECT_TRUE(NaturalLess("a", "b"));
  EXPECT_TRUE(NaturalLess("a", "a1"));
  EXPECT_TRUE(NaturalLess("a2b3", "a2b20"));
  EXPECT_FALSE(NaturalLess("a1", "a1"));
  EXPECT_NE(NaturalLess("a01", "a1"), NaturalLess("a1", "a01"));
}

}  // namespace
}  // namespace flocklift
