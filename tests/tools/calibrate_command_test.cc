// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/calibrate_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>
#include <string>

#include "simulate/camera/camera_io.h"
#include "simulate/core/check.h"
#include "simulate/core/rng.h"
#include "tests/simulate/camera/board_pictures.h"
#include "tools/board_search.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const Board kBoard{.columns = 7, .rows = 5, .square = 0.03};

Camera TrueCamera() {
  Camera camera = PinholeCamera(55, 480, 360);
  camera.intrinsics.cx += 4;
  camera.intrinsics.distortion = {-0.18, 0.05};
  return camera;
}

cv::Mat Picture(const Rigid3d& cam_from_board, std::uint64_t seed) {
  static const BoardPhotographer photographer(TrueCamera());
  static const PrintedBoard printed(kBoard);
  const Image image = photographer.Take(printed, cam_from_board, 1.5, seed);
  return cv::Mat(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.bgr.data()))
      .clone();
}

Rigid3d Pose(Rng* rng) { return RandomPose(PrintedBoard(kBoard), TrueCamera(), 0.7, rng); }

// Pictures and a video that all tests share: made once.
class CalibrateCommandTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    fs::remove_all(Folder());
    fs::create_directories(Folder() / "pictures");
    Rng rng(4);
    std::vector<Rigid3d> poses;
    for (int k = 0; k < 9; ++k) {
      poses.push_back(Pose(&rng));
      cv::imwrite(PictureName(k), Picture(poses.back(), 50 + k));
    }
    cv::imwrite((Folder() / "grey.png").string(), cv::Mat(360, 480, CV_8UC3, cv::Scalar::all(90)));
    std::ofstream(Folder() / "notes.txt") << "no picture";
    // The board stands, is carried on (blurred), stands again.
    cv::VideoWriter video((Folder() / "board.avi").string(),
                          cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25, {480, 360});
    ASSERT_TRUE(video.isOpened());
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const cv::Mat still = Picture(poses[k], 80 + k);
      cv::Mat blurred;
      cv::blur(still, blurred, {25, 1});
      for (int repeat = 0; repeat < 2; ++repeat) {
        video.write(blurred);
        video.write(still);
      }
    }
  }
  static void TearDownTestSuite() { fs::remove_all(Folder()); }

  static fs::path Folder() {
    return fs::path(testing::TempDir()) /
           ("flocklift_calibrate_command_test_" + std::to_string(getpid()));
  }
  static std::string PictureName(int k) {
    return (Folder() / "pictures" / ("view_" + std::to_string(k) + ".png")).string();
  }

  CalibrateCommandTest() { fs::remove_all(out_); }

  void Run(const std::string& arguments) {
    CLI::App app;
    AddCalibrateCommand(app);
    app.parse("calibrate " + arguments + " --quiet --threads 1 --out " + out_.string());
  }
  nlohmann::json Figures() const {
    return nlohmann::json::parse(std::ifstream(out_ / "summary.calibrate.json"))["figures"];
  }
  std::string FaultOf(const std::string& arguments) {
    try {
      Run(arguments);
    } catch (const InputError& error) {
      EXPECT_FALSE(fs::exists(out_ / "camera.yaml"));
      return error.what();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "no fault";
  }

  fs::path out_ = Folder() / "out";
};

TEST_F(CalibrateCommandTest, MakesACameraOfAFolder) {
  Run((Folder() / "pictures").string() + " --board 7x5 --square 0.03 --fps 25");
  const Camera camera = ReadCamera(out_ / "camera.yaml");
  const Intrinsics truth = TrueCamera().intrinsics;
  EXPECT_EQ(camera.width, 480);
  EXPECT_EQ(camera.height, 360);
  EXPECT_EQ(camera.fps, 25);
  EXPECT_FALSE(camera.KnowsGravity());
  EXPECT_NEAR(camera.intrinsics.fx / truth.fx, 1, 0.005);
  EXPECT_NEAR(camera.intrinsics.fy / truth.fy, 1, 0.005);
  const auto figures = Figures();
  EXPECT_EQ(figures["views_used"], 9);
  EXPECT_LT(figures["reprojection_rms_px"], 0.3);
  const double sd = figures["focal_sd_percent"];
  EXPECT_GT(sd, 0.001);
  EXPECT_LT(sd, 0.5);
  EXPECT_NEAR(figures["depth_error_percent"]["size"].get<double>(), sd, 1e-12);
  EXPECT_NEAR(figures["depth_error_percent"]["speed_all_ways"].get<double>(), 2 * sd / 3, 1e-12);
  EXPECT_NEAR(figures["parameters"]["fx"]["value"].get<double>(), camera.intrinsics.fx, 1e-9);
}

TEST_F(CalibrateCommandTest, TakesAPatternAndAListAlike) {
  Run((Folder() / "pictures" / "view_%d.png").string() + " --board 7x5");
  const Camera from_pattern = ReadCamera(out_ / "camera.yaml");
  std::string list;
  for (int k = 0; k < 9; ++k) list += PictureName(k) + " ";
  Run(list + "--board 7x5");
  EXPECT_EQ(ReadCamera(out_ / "camera.yaml"), from_pattern);
}

TEST_F(CalibrateCommandTest, TakesTheSharpFramesOfAVideo) {
  Run((Folder() / "board.avi").string() + " --board 7x5 --views 8");
  const Camera camera = ReadCamera(out_ / "camera.yaml");
  EXPECT_NEAR(camera.intrinsics.fx / TrueCamera().intrinsics.fx, 1, 0.005);
  EXPECT_EQ(Figures()["views_found"], 8);
}

TEST_F(CalibrateCommandTest, TriesTheSharpestFrameOfEachStretch) {
  const BoardSearch search = SearchVideo(Folder() / "board.avi", kBoard, 18, 100, 1, {});
  EXPECT_EQ(search.looked_at, 18);
  EXPECT_EQ(search.views.size(), 9u);  // each pose comes twice
  for (const BoardView& view : search.views) {
    const int frame = std::stoi(view.name.substr(view.name.rfind(' ')));
    EXPECT_EQ(frame % 2, 0) << view.name;  // the others are blurred
  }
}

TEST_F(CalibrateCommandTest, WarnsOfAPictureWithoutTheBoardAmongOthers) {
  Run((Folder() / "pictures").string() + " " + (Folder() / "grey.png").string() + " --board 7x5");
  const auto summary = nlohmann::json::parse(std::ifstream(out_ / "summary.calibrate.json"));
  EXPECT_THAT(summary["warnings"].dump(), HasSubstr("grey.png"));
  EXPECT_EQ(summary["figures"]["views_used"], 9);
}

TEST_F(CalibrateCommandTest, TellsEveryFaultInOneLine) {
  const std::string pictures = (Folder() / "pictures").string();
  EXPECT_THAT(
      FaultOf((Folder() / "grey.png").string() + " --board 7x5"),
      HasSubstr("no 7x5 chessboard is seen here, and 0 different views of one in 1 pictures"));
  EXPECT_THAT(FaultOf(PictureName(0) + " " + PictureName(1) + " --board 7x5"),
              HasSubstr("2 different views of a 7x5 chessboard in 2 pictures; give at least 4"));
  const std::string same = PictureName(0) + " ";
  EXPECT_THAT(FaultOf(same + same + same + same + "--board 7x5"),
              HasSubstr("1 different views of a 7x5 chessboard in 4 pictures"));
  EXPECT_THAT(FaultOf(PictureName(0) + " --board 8x6"),
              HasSubstr("0 different views of one in 1 pictures"));
  EXPECT_THAT(FaultOf(pictures + " --charuco 5x7 --square 0.04 --marker 0.02"),
              HasSubstr("no 5x7 ChArUco board"));
  EXPECT_THAT(FaultOf(pictures), HasSubstr("--board 9x6"));
  EXPECT_THAT(FaultOf(pictures + " --charuco 5x7"), HasSubstr("--square and --marker"));
  EXPECT_THAT(FaultOf(pictures + " --charuco 5x7 --square 0.02 --marker 0.04"),
              HasSubstr("marker"));
  EXPECT_THAT(FaultOf(pictures + " --charuco 5x7 --square 2 --marker 1 --dictionary DICT_4X4_5"),
              HasSubstr("DICT_4X4_50"));
  EXPECT_THAT(FaultOf(pictures + " --board 1x6"), HasSubstr("1x6 inner corners"));
  EXPECT_THAT(FaultOf(pictures + " --board 7x5 --distortion 6"), HasSubstr("4, 5, 8 or 12"));
  EXPECT_THAT(FaultOf((Folder() / "nowhere.png").string() + " --board 7x5"),
              HasSubstr("no such file"));
  EXPECT_THAT(FaultOf((Folder() / "pictures" / "x_%02d.png").string() + " --board 7x5"),
              HasSubstr("no picture matches"));
  EXPECT_THAT(FaultOf((Folder() / "notes.txt").string() + " --board 7x5"), HasSubstr("no video"));
  EXPECT_THAT(FaultOf((Folder() / "notes.txt").string() + " " + PictureName(0) + " --board 7x5"),
              HasSubstr("no picture"));
  EXPECT_THROW(Run(pictures + " --board seven"), CLI::ParseError);
  EXPECT_THROW(Run(pictures + " --board 7x5 --charuco 5x7"), CLI::ParseError);
  EXPECT_THROW(Run("--board 7x5"), CLI::ParseError);

  const auto small = Folder() / "small.png";
  cv::imwrite(small.string(), cv::Mat(100, 100, CV_8UC3, cv::Scalar::all(90)));
  EXPECT_THAT(FaultOf(pictures + " " + small.string() + " --board 7x5"),
              HasSubstr("100x100, the first is 480x360"));
  std::ofstream(Folder() / "cut.png", std::ios::binary) << "\x89PNG\r\n\x1a\n and no more";
  EXPECT_THAT(FaultOf((Folder() / "cut.png").string() + " --board 7x5"),
              HasSubstr("cannot be decoded"));
}

}  // namespace
}  // namespace flocklift
