// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/camera/camera_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <string>

#include "simulate/core/check.h"
#include "simulate/core/rng.h"

namespace flocklift {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kGood = R"(%YAML:1.0
---
image_width: 1920
image_height: 1080
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 1500., 0., 959.5, 0., 1500.5, 539.5, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -1.0e-01, 2.5e-02, 1e-3, -1e-3, .5 ]
)";

std::string Replace(std::string text, const std::string& what, const std::string& with) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), with);
}

std::string FaultOf(const std::string& text) {
  try {
    ParseCamera(text, "cam.yaml");
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "no fault";
}

std::filesystem::path ScratchFolder() {
  return std::filesystem::path(testing::TempDir()) /
         ("flocklift_camera_io_test_" + std::to_string(getpid()));
}
class RemoveScratch : public testing::Environment {
  void TearDown() override { std::filesystem::remove_all(ScratchFolder()); }
};
const auto* const kRemoveScratch = testing::AddGlobalTestEnvironment(new RemoveScratch);

std::filesystem::path Scratch(const std::string& name) {
  std::filesystem::create_directories(ScratchFolder());
  return ScratchFolder() / name;
}

Camera RandomCamera(Rng* rng, int coefficients) {
  Camera camera = PinholeCamera(rng->Uniform(20, 120), 1280, 720);
  camera.intrinsics.fy *= rng->Uniform(0.9, 1.1);
  for (int i = 0; i < coefficients; ++i) camera.intrinsics.distortion[i] = 0.1 * rng->Normal();
  camera.fps = 30000.0 / 1001;
  camera.cam_from_world =
      LookAt({rng->Normal(), rng->Normal(), rng->Normal()}, {9 * rng->Normal(), 20, 5});
  return camera;
}

TEST(ReadCamera, ReadsWhatOpenCvsSampleWrites) {
  const cv::Mat matrix =
      (cv::Mat_<double>(3, 3) << 1234.5678901234567, 0, 640.123, 0, 1236.7654321, 359.5, 0, 0, 1);
  const cv::Mat distortion = (cv::Mat_<double>(5, 1) << -0.31, 0.12, 1e-3, -2e-4, -0.02);
  const auto path = Scratch("sample.yaml");
  {
    // Keys and order of samples/cpp/calibration.cpp and the camera calibration tutorial.
    cv::FileStorage fs(path.string(), cv::FileStorage::WRITE);
    fs << "calibration_time"
       << "Thu 01 Jan 2026 [noon]: \"fine\"";
    fs << "nr_of_frames" << 12 << "image_width" << 1280 << "image_height" << 720;
    fs << "board_width" << 9 << "board_height" << 6 << "square_size" << 0.025;
    fs << "aspectRatio" << 1.0;
    fs.writeComment(" flags: +fix_aspectRatio +zero_tangent_dist: [");
    fs << "flags" << 6 << "fisheye_model" << 0;
    fs << "camera_matrix" << matrix << "distortion_coefficients" << distortion;
    fs << "avg_reprojection_error" << 0.21;
    fs << "per_view_reprojection_errors" << cv::Mat(12, 1, CV_32F, cv::Scalar(0.2));
    fs << "extrinsic_parameters" << cv::Mat(12, 6, CV_64F, cv::Scalar(0.1));
    fs << "image_points" << cv::Mat(12, 54, CV_32FC2, cv::Scalar(3, 4));
    fs << "names"
       << "["
       << "a.png"
       << "b: c.png"
       << "]";
    fs << "grid" << std::vector<cv::Point3f>(3, {1, 2, 3});
  }
  const Camera camera = ReadCamera(path);
  EXPECT_EQ(camera.width, 1280);
  EXPECT_EQ(camera.height, 720);
  EXPECT_EQ(
      camera.intrinsics,
      (Intrinsics{
          1234.5678901234567, 1236.7654321, 640.123, 359.5, {-0.31, 0.12, 1e-3, -2e-4, -0.02}}));
  EXPECT_FALSE(camera.fps || camera.cam_from_world);
  EXPECT_TRUE(camera.cam_from_world_per_frame.empty());
}

TEST(ReadCamera, ReadsEveryWayInWhichOpenCvWritesNumbers) {
  Rng rng(8);
  for (int trial = 0; trial < 50; ++trial) {
    const Camera expected = RandomCamera(&rng, 8);
    const auto path = Scratch("numbers.yaml");
    {
      const Intrinsics& k = expected.intrinsics;
      cv::FileStorage fs(path.string(), cv::FileStorage::WRITE);
      fs << "image_width" << 1280 << "image_height" << 720;
      fs << "fps" << *expected.fps;
      fs << "camera_matrix" << (cv::Mat_<double>(3, 3) << k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1);
      fs << "distortion_coefficients"
         << std::vector<double>(k.distortion.begin(), k.distortion.begin() + 8);
    }
    const Camera camera = ReadCamera(path);
    EXPECT_EQ(camera.intrinsics, expected.intrinsics);
    EXPECT_EQ(camera.fps, expected.fps);
  }
}

TEST(WriteCamera, ReadsBackBitByBitHereAndInOpenCv) {
  Rng rng(9);
  for (const int coefficients : {0, 4, 5, 8, 12}) {
    Camera camera = RandomCamera(&rng, coefficients);
    for (int k = 0; k < 5; ++k) {
      camera.cam_from_world_per_frame.push_back(*RandomCamera(&rng, 0).cam_from_world);
    }
    const auto path = Scratch("written.yaml");
    WriteCamera(path, camera);
    EXPECT_EQ(ReadCamera(path), camera);

    const cv::FileStorage fs(path.string(), cv::FileStorage::READ);
    cv::Mat matrix, distortion, pose, poses;
    fs["camera_matrix"] >> matrix;
    fs["distortion_coefficients"] >> distortion;
    fs["cam_from_world"] >> pose;
    fs["cam_from_world_per_frame"] >> poses;
    EXPECT_EQ(static_cast<int>(fs["image_width"]), camera.width);
    EXPECT_EQ(static_cast<double>(fs["fps"]), *camera.fps);
    EXPECT_EQ(matrix.at<double>(0, 0), camera.intrinsics.fx);
    EXPECT_EQ(matrix.at<double>(1, 2), camera.intrinsics.cy);
    EXPECT_EQ(matrix.at<double>(2, 2), 1);
    for (int i = 0; i < distortion.rows; ++i) {
      EXPECT_EQ(distortion.at<double>(i), camera.intrinsics.distortion[i]);
    }
    EXPECT_EQ(pose.size(), cv::Size(4, 3));
    EXPECT_EQ(pose.at<double>(1, 3), camera.cam_from_world->translation.y);
    EXPECT_EQ(poses.size(), cv::Size(12, 5));
    EXPECT_EQ(poses.at<double>(4, 10), camera.cam_from_world_per_frame[4].rotation.m[8]);
  }
}

TEST(WriteCamera, LeavesTheOldFileWhenItCannotWrite) {
  const auto file = Scratch("not_a_folder");
  std::ofstream(file) << "text";
  EXPECT_THROW(WriteCamera(file / "camera.yaml", PinholeCamera(50, 64, 48)), std::runtime_error);
}

TEST(ParseCamera, AcceptsWhatPeopleWrite) {
  const Camera camera = ParseCamera(
      "# GoPro, by hand\r\n"
      "image_width: 1920   # px\r\n"
      "image_height: 1080\r\n"
      "Camera_Matrix: [[1500, 0, 959.5],\r\n"
      "                [0, 1500, 539.5],\r\n"
      "                [0, 0, 1]]\r\n"
      "distortion_coefficients: [0, 0, 0, 0]\r\n"
      "fps: 30000/1001\r\n",
      "x");
  EXPECT_EQ(camera.intrinsics, (Intrinsics{1500, 1500, 959.5, 539.5, {}}));
  EXPECT_DOUBLE_EQ(*camera.fps, 30000.0 / 1001);
  EXPECT_DOUBLE_EQ(*ParseCamera(kGood + "fps: \"25/2\"\n", "x").fps, 12.5);
  EXPECT_DOUBLE_EQ(*ParseCamera(kGood + "fps: 25", "x").fps, 25);
  EXPECT_DOUBLE_EQ(*ParseCamera(kGood + "fps: 25.\n...\nrest", "x").fps, 25);
  // ROS writes the maps without a tag; a list may be one of dashes.
  EXPECT_EQ(ParseCamera(Replace(kGood, " !!opencv-matrix", ""), "x").intrinsics,
            ParseCamera(kGood, "x").intrinsics);
  const std::string dashes = "distortion_coefficients:\n- 0.1\n- -0.2\n   - 0\n   - 0\n";
  const auto at = kGood.find("distortion_coefficients");
  EXPECT_EQ(ParseCamera(kGood.substr(0, at) + dashes, "x").intrinsics.distortion[1], -0.2);
  // 14 coefficients without tilt are 12.
  const auto fourteen = ParseCamera(
      kGood.substr(0, at) + "distortion_coefficients: [1e-3,2e-3,0,0,0,0,0,0,0,0,0,5e-4,0,0]", "x");
  EXPECT_EQ(fourteen.intrinsics.distortion[11], 5e-4);
}

TEST(ParseCamera, TakesRAndTWithoutCamFromWorld) {
  const std::string r = "R: [1, 0, 0, 0, 0, -1, 0, 1, 0]\nt: [[1], [2], [3]]\n";
  const Camera camera = ParseCamera(kGood + r, "x");
  EXPECT_EQ(*camera.cam_from_world * Vec3d({0, 5, 0}), (Vec3d{1, 2, 8}));
  const std::string both =
      kGood + r + "cam_from_world: [[1, 0, 0, 7], [0, 1, 0, 8], [0, 0, 1, 9]]\n";
  EXPECT_EQ(ParseCamera(both, "x").cam_from_world->translation, (Vec3d{7, 8, 9}));
  EXPECT_THAT(FaultOf(kGood + "R: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"), HasSubstr("R stands without t"));
  EXPECT_THAT(FaultOf(kGood + "t: [0, 0, 0]\n"), HasSubstr("t stands without R"));
}

TEST(ParseCamera, MendsTheRoundingOfPrintedDigits) {
  const Camera camera =
      ParseCamera(kGood +
                      "cam_from_world: [[0.80000, 0.60000, 0, 0], [-0.60001, 0.79999, 0, 0], "
                      "[0, 0, 1, 0]]",
                  "x");
  const auto& r = camera.cam_from_world->rotation;
  EXPECT_NEAR(Norm(r * Vec3d{0, 1, 0}), 1, 1e-15);
  EXPECT_NEAR(r.m[0], 0.8, 1e-4);
}

struct Fault {
  std::string name, from, to, message;  // a replacement in the good file, and what is said of it
};

class Faults : public testing::TestWithParam<Fault> {};

TEST_P(Faults, IsToldInOneLine) {
  const Fault& fault = GetParam();
  const std::string text =
      fault.from.empty() ? kGood + fault.to : Replace(kGood, fault.from, fault.to);
  EXPECT_THAT(FaultOf(text),
              AllOf(StartsWith("cam.yaml:"), HasSubstr(fault.message), HasSubstr("; ")));
}

INSTANTIATE_TEST_SUITE_P(
    All, Faults,
    testing::Values(
        Fault{"MissingWidth", "image_width: 1920\n", "", "image_width is missing"},
        Fault{"MissingMatrix", "camera_matrix", "other_matrix", "camera_matrix is missing"},
        Fault{"MissingDistortion", "distortion_c", "other_c", "distortion_coefficients is missing"},
        Fault{"ZeroWidth", "1920", "0", "cam.yaml:3: image_width is 0"},
        Fault{"NegativeHeight", "1080", "-1080", "cam.yaml:4: image_height is -1080"},
        Fault{"FractionalWidth", "1920", "1920.5", "image_width is 1920.5"},
        Fault{"WidthIsText", "1920", "wide", "cam.yaml:3: image_width holds"},
        Fault{"WidthIsList", "1920", "[1920]", "cam.yaml:3: image_width holds"},
        Fault{"WidthTwice", "1920", "1920 1920", "image_width is followed by"},
        Fault{"NanInMatrix", "959.5", ".NaN", "cam.yaml:9: camera_matrix holds"},
        Fault{"InfInMatrix", "959.5", "-.Inf", "cam.yaml:9: camera_matrix holds"},
        Fault{"OverflowInMatrix", "959.5", "1e999", "cam.yaml:9: camera_matrix holds"},
        Fault{"NanInDistortion", "2.5e-02", "nan", "cam.yaml:14: distortion_coefficients holds"},
        Fault{"WordInMatrix", "959.5", "middle", "cam.yaml:9: camera_matrix holds"},
        Fault{"Singular", "1500.,", "0.,", "cam.yaml:5: camera_matrix is singular"},
        Fault{"ZeroCorner", "0., 0., 1. ]", "0., 0., 0. ]", "singular"},
        Fault{"NotHomogeneous", "0., 0., 1. ]", "0., 0., 2. ]", "last row"},
        Fault{"Skewed", "1500., 0.,", "1500., 3.,", "skew of 3"},
        Fault{"NegativeFocal", "1500.5", "-1500.5", "focal length is negative"},
        Fault{"FocalInMillimetres", "1500.,", "4.2,", "millimetres"},
        Fault{"TooFewValues", ", 0., 0., 1. ]", " ]", "6 values for 3 x 3"},
        Fault{"WrongSize", "rows: 3\n   cols: 3", "rows: 9\n   cols: 1", "camera_matrix is 9 x 1"},
        Fault{"NoRows", "   rows: 3\n", "", "camera_matrix has no rows"},
        Fault{"BadRows", "rows: 3", "rows: 3.5", "whole numbers"},
        Fault{"Channels", "dt: d", "dt: \"3d\"", "one channel"},
        Fault{"Unclosed", "1. ]", "1.", "is not closed"},
        Fault{"Base64", "[ 1500., 0., 959.5, 0., 1500.5, 539.5, 0., 0., 1. ]", "\"$base64$ZAAA\"",
              "base64"},
        Fault{"ThreeCoefficients", "rows: 5\n   cols: 1\n   dt: d\n   data: [ -1.0e-01, 2.5e-02,",
              "rows: 3\n   cols: 1\n   dt: d\n   data: [", "there are 3 distortion coefficients"},
        Fault{"Tilted",
              "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n"
              "   data: [ -1.0e-01, 2.5e-02, 1e-3, -1e-3, .5 ]",
              "distortion_coefficients: [0,0,0,0,0,0,0,0,0,0,0,0,.1,0]", "tilted"},
        Fault{"SquareDistortion", "rows: 5\n   cols: 1\n   dt: d\n   data: [ -1.0e-01,",
              "rows: 2\n   cols: 2\n   dt: d\n   data: [", "2 x 2"},
        Fault{"Fisheye", "", "fisheye_model: 1\n",
              "cam.yaml:15: the camera was calibrated as a fish"},
        Fault{"Equidistant", "", "distortion_model: Equidistant\n", "another model"},
        Fault{"Omnidirectional", "", "xi: 1.2\n", "omnidirectional"},
        Fault{"FpsZero", "", "fps: 0\n", "cam.yaml:15: fps is not"},
        Fault{"FpsNan", "", "fps: nan\n", "fps is not"},
        Fault{"FpsRatioByZero", "", "fps: 30/0\n", "fps is not"},
        Fault{"FpsText", "", "fps: fast\n", "fps is not"},
        Fault{"FpsEmpty", "", "fps:\n", "fps is empty"},
        Fault{"NoRotation", "", "cam_from_world: [[1,0,0,0],[0,2,0,0],[0,0,1,0]]\n",
              "cam.yaml:15: the rotation of"},
        Fault{"Mirror", "", "cam_from_world: [[1,0,0,0],[0,1,0,0],[0,0,-1,0]]\n", "mirror"},
        Fault{"PoseOfWrongSize", "", "cam_from_world: [[1,0,0],[0,1,0],[0,0,1]]\n", "3 x 3"},
        Fault{"PoseNan", "", "cam_from_world: [[1,0,0,0],\n [0,1,0,nan],\n [0,0,1,0]]\n",
              "cam.yaml:16: cam_from_world holds"},
        Fault{"UnevenRows", "", "cam_from_world: [[1,0,0,0],[0,1,0],[0,0,1,0]]\n",
              "differ in length"},
        Fault{"TooDeep", "", "cam_from_world: [[[1]]]\n", "nested"},
        Fault{"MixedList", "", "cam_from_world: [[1,0,0,0], 4]\n", "mixes"},
        Fault{"PerFrameOfWrongSize", "", "cam_from_world_per_frame: [1,2,3]\n", "not F x 12"},
        Fault{"PerFrameEmpty", "", "cam_from_world_per_frame: []\n", "not F x 12"},
        Fault{"PerFrameNoRotation", "",
              "cam_from_world_per_frame: [[1,0,0,0,0,1,0,0,0,0,1,0],[1,0,0,0,0,1,0,0,0,0,3,0]]\n",
              "frame 2,"},
        Fault{"DuplicateKey", "", "image_width: 3\n", "of line 3 comes again"},
        Fault{"NoColon", "", "hello there\n", "cam.yaml:15: `hello there` is no 'key: value'"},
        Fault{"SecondDocument", "", "---\nimage_width: 3\n", "second document"},
        Fault{"IndentedFirstLine", "%YAML:1.0\n---\n", "  a: 1\n", "indented"},
        Fault{"NotText", "959.5", std::string("9\0", 2), "not text"}),
    [](const auto& info) { return info.param.name; });

TEST(ParseCamera, SaysWhatIsNoYaml) {
  EXPECT_THAT(FaultOf(""), HasSubstr("empty"));
  EXPECT_THAT(FaultOf(" \n\n"), HasSubstr("empty"));
  EXPECT_THAT(FaultOf("<?xml version=\"1.0\"?>\n<opencv_storage>"), HasSubstr("XML"));
  EXPECT_THAT(FaultOf("{ \"image_width\": 3 }"), HasSubstr("JSON"));
}

TEST(ReadCamera, NamesAFileThatIsNotThere) {
  EXPECT_THROW(ReadCamera(Scratch("nowhere.yaml")), InputError);
  EXPECT_THROW(ReadCamera(Scratch("")), InputError);
}

// Damage of every kind is an InputError or a camera, never anything else.
TEST(ParseCamera, SurvivesDamage) {
  const std::string whole =
      kGood + "fps: \"30000/1001\"\ncam_from_world: [[1,0,0,0],[0,1,0,0],[0,0,1,0]]\n";
  Rng rng(10);
  const std::string odd = "[]{}:,-#\"'!.\n \te9";
  for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
    try {
      ParseCamera(whole.substr(0, cut), "x");
    } catch (const InputError&) {
    }
  }
  for (int trial = 0; trial < 20000; ++trial) {
    std::string text = whole;
    for (int change = 0; change < 3; ++change) {
      text[rng.Below(static_cast<std::uint32_t>(text.size()))] =
          odd[rng.Below(static_cast<std::uint32_t>(odd.size()))];
    }
    try {
      ParseCamera(text, "x");
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace flocklift
