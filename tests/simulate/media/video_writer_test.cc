// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/media/video_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>
#include <string>

namespace flocklift {
namespace {

namespace fs = std::filesystem;

class VideoWriterTest : public ::testing::Test {
 protected:
  VideoWriterTest() {
    folder_ = fs::path(::testing::TempDir()) / ("flocklift_video_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~VideoWriterTest() override { fs::remove_all(folder_); }

  // A smooth coloured pattern that moves with the frame number; every frame differs.
  static Image Picture(int width, int height, int frame) {
    Image image(width, height);
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const double wave = std::sin((u + 3.0 * frame) * 0.05) * std::cos(v * 0.04);
        image.Row(v)[3 * u + 0] = static_cast<std::uint8_t>(150 + 60 * wave);
        image.Row(v)[3 * u + 1] = static_cast<std::uint8_t>(128 + 40 * wave);
        image.Row(v)[3 * u + 2] = static_cast<std::uint8_t>(100 - 50 * wave);
      }
    }
    return image;
  }

  void WriteFilm(const fs::path& path, int width, int height, double fps, int frames,
                 const VideoOptions& options = {}) {
    VideoWriter writer(path, width, height, fps, options);
    for (int k = 0; k < frames; ++k) writer.Write(Picture(width, height, k));
    writer.Finish();
  }

  static std::string Bytes(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::vector<std::string> Files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      names.push_back(entry.path().filename().string());
    }
    return names;
  }

  // Reads the film back with OpenCV: counts the frames, returns the largest mean error of one
  // [grey levels], the picture of frame k compared with Picture(k).
  static double WorstMeanError(const fs::path& path, int width, int height, int* frames) {
    cv::VideoCapture capture(path.string());
    EXPECT_TRUE(capture.isOpened());
    double worst = 0;
    cv::Mat read;
    for (*frames = 0; capture.read(read); ++*frames) {
      Image expected = Picture(width, height, *frames);
      const cv::Mat whole(height, width, CV_8UC3, expected.bgr.data());
      const cv::Mat part = read(cv::Rect(0, 0, width, height));
      worst = std::max(worst, cv::norm(whole, part, cv::NORM_L1) / (3.0 * width * height));
    }
    return worst;
  }

  fs::path folder_;
};

TEST_F(VideoWriterTest, OpenCvReadsTheSamePicturesBack) {
  const fs::path path = folder_ / "film.mp4";
  WriteFilm(path, 320, 180, 25, 40);
  int frames = 0;
  const double worst = WorstMeanError(path, 320, 180, &frames);
  EXPECT_EQ(frames, 40);
  EXPECT_LT(worst, 2.5);
  cv::VideoCapture capture(path.string());
  EXPECT_EQ(capture.get(cv::CAP_PROP_FRAME_COUNT), 40);
  EXPECT_DOUBLE_EQ(capture.get(cv::CAP_PROP_FPS), 25);
  EXPECT_EQ(capture.get(cv::CAP_PROP_FRAME_WIDTH), 320);
  EXPECT_EQ(capture.get(cv::CAP_PROP_FRAME_HEIGHT), 180);
}

TEST_F(VideoWriterTest, FrameRateIsARatio) {
  for (const double fps : {30000.0 / 1001.0, 29.97, 12.5, 60.0}) {
    const fs::path path = folder_ / "film.mp4";
    WriteFilm(path, 64, 48, fps, 30);
    cv::VideoCapture capture(path.string());
    EXPECT_NEAR(capture.get(cv::CAP_PROP_FPS), fps, 1e-9 * fps);
    EXPECT_EQ(capture.get(cv::CAP_PROP_FRAME_COUNT), 30);
  }
}

TEST_F(VideoWriterTest, SimplestRatios) {
  const auto expect = [](double fps, int numerator, int denominator) {
    const FrameRate rate = FrameRate::Nearest(fps);
    EXPECT_EQ(rate.numerator, numerator) << fps;
    EXPECT_EQ(rate.denominator, denominator) << fps;
  };
  expect(25, 25, 1);
  expect(29.97, 2997, 100);
  expect(30000.0 / 1001.0, 30000, 1001);
  expect(0.5, 1, 2);
}

TEST_F(VideoWriterTest, SingleFrame) {
  const fs::path path = folder_ / "film.mp4";
  WriteFilm(path, 64, 48, 30, 1);
  int frames = 0;
  EXPECT_LT(WorstMeanError(path, 64, 48, &frames), 2.5);
  EXPECT_EQ(frames, 1);
}

TEST_F(VideoWriterTest, OddSizesGrowByOneAndKeepTheirPixels) {
  for (const auto& [width, height] : {std::pair{161, 91}, std::pair{160, 91}, std::pair{1, 1}}) {
    const fs::path path = folder_ / "film.mp4";
    WriteFilm(path, width, height, 30, 5);
    cv::VideoCapture capture(path.string());
    EXPECT_EQ(capture.get(cv::CAP_PROP_FRAME_WIDTH), width + width % 2);
    EXPECT_EQ(capture.get(cv::CAP_PROP_FRAME_HEIGHT), height + height % 2);
    int frames = 0;
    EXPECT_LT(WorstMeanError(path, width, height, &frames), 3);
    EXPECT_EQ(frames, 5);
  }
}

TEST_F(VideoWriterTest, SameFramesSameBytes) {
  WriteFilm(folder_ / "a.mp4", 320, 180, 30, 60);
  WriteFilm(folder_ / "b.mp4", 320, 180, 30, 60);
  const std::string bytes = Bytes(folder_ / "a.mp4");
  EXPECT_GT(bytes.size(), 1000U);
  EXPECT_TRUE(bytes == Bytes(folder_ / "b.mp4"));
}

TEST_F(VideoWriterTest, IndexComesBeforeTheFrames) {
  WriteFilm(folder_ / "film.mp4", 64, 48, 30, 3);
  const std::string bytes = Bytes(folder_ / "film.mp4");
  const std::size_t index = bytes.find("moov");
  ASSERT_NE(index, std::string::npos);
  EXPECT_LT(index, bytes.find("mdat"));
}

TEST_F(VideoWriterTest, Mpeg4WhereThereIsNoH264) {
  const fs::path path = folder_ / "film.mp4";
  WriteFilm(path, 320, 180, 30000.0 / 1001.0, 40, {.encoder = "mpeg4"});
  int frames = 0;
  EXPECT_LT(WorstMeanError(path, 320, 180, &frames), 3);
  EXPECT_EQ(frames, 40);
  cv::VideoCapture capture(path.string());
  EXPECT_NEAR(capture.get(cv::CAP_PROP_FPS), 30000.0 / 1001.0, 1e-6);
}

TEST_F(VideoWriterTest, LowerCrfIsNearerToTheOriginal) {
  WriteFilm(folder_ / "fine.mp4", 320, 180, 30, 10, {.crf = 10});
  WriteFilm(folder_ / "coarse.mp4", 320, 180, 30, 10, {.crf = 45});
  int frames = 0;
  EXPECT_LT(WorstMeanError(folder_ / "fine.mp4", 320, 180, &frames),
            WorstMeanError(folder_ / "coarse.mp4", 320, 180, &frames));
}

TEST_F(VideoWriterTest, NothingIsLeftWithoutFinish) {
  {
    VideoWriter writer(folder_ / "film.mp4", 64, 48, 30);
    for (int k = 0; k < 20; ++k) writer.Write(Picture(64, 48, k));
    EXPECT_FALSE(fs::exists(folder_ / "film.mp4"));
  }
  EXPECT_THAT(Files(), ::testing::IsEmpty());
  WriteFilm(folder_ / "film.mp4", 64, 48, 30, 2);
  EXPECT_THAT(Files(), ::testing::ElementsAre("film.mp4"));
}

TEST_F(VideoWriterTest, RefusesWhatItCannotDo) {
  const fs::path path = folder_ / "film.mp4";
  EXPECT_THROW(VideoWriter(path, 0, 48, 30), std::invalid_argument);
  EXPECT_THROW(VideoWriter(path, 64, 48, 0), std::invalid_argument);
  EXPECT_THROW(VideoWriter(path, 64, 48, -5), std::invalid_argument);
  EXPECT_THROW(VideoWriter(path, 64, 48, std::nan("")), std::invalid_argument);
  EXPECT_THROW(VideoWriter(path, 64, 48, 30, {.crf = 52}), std::invalid_argument);
  EXPECT_THROW(VideoWriter(path, 64, 48, 30, {.encoder = "no such"}), std::invalid_argument);
  EXPECT_THROW(VideoWriter(path, 64, 48, 30, {.preset = "no such"}), std::invalid_argument);
  VideoWriter writer(path, 64, 48, 30);
  EXPECT_THROW(writer.Write(Image(48, 64)), std::invalid_argument);
  writer.Write(Image(64, 48));
  writer.Finish();
  EXPECT_THROW(writer.Write(Image(64, 48)), std::invalid_argument);
  EXPECT_THROW(writer.Finish(), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
