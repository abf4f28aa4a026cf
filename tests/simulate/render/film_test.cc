// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/film.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/videoio.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "simulate/render/flight.h"
#include "simulate/render/renderer.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

Trajectories TwoBirds(int frames) {
  Trajectories t;
  for (Id id = 1; id <= 2; ++id) {
    Trajectory& bird = t.trajectories.emplace_back();
    bird.id = id;
    for (int frame = 1; frame <= frames; ++frame) {
      TrajectoryPoint& point = bird.points.emplace_back();
      point.frame = frame;
      point.position = {-1.0 + 0.15 * frame, 0.8 * static_cast<double>(id) - 1.2, 12};
    }
  }
  return t;
}

std::string Bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class FilmTest : public ::testing::Test {
 protected:
  FilmTest()
      : folder_(fs::path(::testing::TempDir()) / ("flocklift_film_" + std::to_string(::getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~FilmTest() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(FilmTest, SameBytesAtAnyNumberOfThreads) {
  const Camera camera = PinholeCamera(40, 192, 108);
  std::vector<std::string> films;
  for (const int threads : {1, 2, 5}) {
    const fs::path path = folder_ / "film.mp4";
    FilmTrajectories(path, TwoBirds(20), {}, camera, {}, {.fps = 25, .threads = threads});
    films.push_back(Bytes(path));
  }
  EXPECT_GT(films[0].size(), 1000U);
  EXPECT_TRUE(films[0] == films[1]);
  EXPECT_TRUE(films[0] == films[2]);
}

TEST_F(FilmTest, FramesComeInOrderAndShowTheBirds) {
  const Camera camera = PinholeCamera(40, 192, 108);
  const RenderSpec spec{.background = "sky", .noise = 0, .blur = 0.3, .haze = 100};
  const fs::path path = folder_ / "film.mp4";
  std::vector<std::int64_t> reported;
  FilmTrajectories(path, TwoBirds(20), {}, camera, spec, {.fps = 25, .seed = 4, .threads = 3},
                   [&](std::int64_t done, std::int64_t total) {
                     EXPECT_EQ(total, 20);
                     reported.push_back(done);
                   });
  ASSERT_EQ(reported.size(), 20U);
  for (std::size_t k = 0; k < 20; ++k) EXPECT_EQ(reported[k], static_cast<std::int64_t>(k) + 1);

  const FlockRenderer renderer(camera, spec, 25, 4);
  const Flight flight(TwoBirds(20), {}, camera, 25);
  cv::VideoCapture capture(path.string());
  EXPECT_EQ(capture.get(cv::CAP_PROP_FPS), 25);
  cv::Mat read;
  for (int frame = 1; frame <= 20; ++frame) {
    ASSERT_TRUE(capture.read(read)) << frame;
    const Image drawn = renderer.Render(frame, flight.TimeOf(frame), flight.At(frame));
    double error = 0, signal = 0;
    const Image empty = renderer.Render(frame, 0, {});
    for (int v = 0; v < drawn.height; ++v) {
      for (int u = 0; u < drawn.width; ++u) {
        error += std::abs(read.at<cv::Vec3b>(v, u)[1] - drawn.Row(v)[3 * u + 1]);
        signal += std::abs(empty.Row(v)[3 * u + 1] - drawn.Row(v)[3 * u + 1]);
      }
    }
    EXPECT_LT(error / (192 * 108), 2.5) << frame;
    EXPECT_GT(signal, 500) << frame;
  }
  EXPECT_FALSE(capture.read(read));
}

TEST_F(FilmTest, MayGoOnAfterTheLastBird) {
  const fs::path path = folder_ / "film.mp4";
  FilmTrajectories(path, TwoBirds(3), {}, PinholeCamera(40, 64, 48), {}, {.fps = 25, .frames = 8});
  EXPECT_EQ(cv::VideoCapture(path.string()).get(cv::CAP_PROP_FRAME_COUNT), 8);
}

TEST_F(FilmTest, AFailureLeavesNoFile) {
  const fs::path path = folder_ / "film.mp4";
  const Camera camera = PinholeCamera(40, 64, 48);
  EXPECT_THROW(FilmTrajectories(path, {}, {}, camera, {}, {}), std::invalid_argument);
  EXPECT_THROW(FilmTrajectories(path, TwoBirds(30), {}, camera, {}, {.threads = 3},
                                [](std::int64_t done, std::int64_t) {
                                  if (done == 5) throw std::runtime_error("stop");
                                }),
               std::runtime_error);
  EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace flocklift
