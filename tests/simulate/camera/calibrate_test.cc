// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/camera/calibrate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core/utility.hpp>
#include <string>
#include <vector>

#include "simulate/camera/board.h"
#include "simulate/camera/board_views.h"
#include "simulate/camera/projection.h"
#include "simulate/core/rng.h"
#include "tests/simulate/camera/board_pictures.h"

namespace flocklift {
namespace {

// OpenCV's idle threads spin, which hurts where tests run side by side.
class OneThread : public testing::Environment {
  void SetUp() override { cv::setNumThreads(1); }
};
const auto* const kOneThread = testing::AddGlobalTestEnvironment(new OneThread);

const Board kChessboard{.columns = 9, .rows = 6, .square = 0.025};
const Board kCharuco{.kind = Board::Kind::kCharuco,
                     .columns = 7,
                     .rows = 5,
                     .square = 0.03,
                     .marker = 0.022,
                     .dictionary = "DICT_4X4_50"};

Camera TrueCamera() {
  Camera camera = PinholeCamera(58, 720, 540);
  camera.intrinsics.fy *= 1.003;
  camera.intrinsics.cx += 7.3;
  camera.intrinsics.cy -= 4.6;
  camera.intrinsics.distortion = {-0.21, 0.09, 8e-4, -5e-4};
  return camera;
}

// The corners as the camera sees them, without a picture, each with Gaussian noise.
std::vector<BoardView> ProjectedViews(const Camera& camera, int count, double tilt, double noise,
                                      std::uint64_t seed) {
  const PrintedBoard printed(kChessboard);
  Rng rng(seed);
  std::vector<BoardView> views;
  for (int i = 0; i < count; ++i) {
    const Rigid3d cam_from_board = RandomPose(printed, camera, tilt, &rng);
    BoardView view;
    for (int k = 0; k < 54; ++k) {
      const Vec3d p{0.025 * (k % 9), 0.025 * (k / 9), 0};
      const Vec2d pixel = Project(camera.intrinsics, cam_from_board * (p + Vec3d{0.025, 0.025, 0}));
      view.on_board.push_back(p);
      view.pixels.push_back({pixel.x + noise * rng.Normal(), pixel.y + noise * rng.Normal()});
    }
    views.push_back(view);
  }
  return views;
}

// Largest angle between the rays of two cameras through the same pixel, times the focal length
// [px].
double WorstRayError(const Camera& truth, const Camera& estimate) {
  double worst = 0;
  for (int v = 0; v < truth.height; v += 50) {
    for (int u = 0; u < truth.width; u += 50) {
      const Vec2d pixel{static_cast<double>(u), static_cast<double>(v)};
      const auto a = RayThroughPixel(truth.intrinsics, pixel);
      const auto b = RayThroughPixel(estimate.intrinsics, pixel);
      if (!a || !b) return 1e9;
      worst = std::max(worst, std::hypot(a->x - b->x, a->y - b->y) * truth.intrinsics.fx);
    }
  }
  return worst;
}

const BoardPhotographer& Photographer() {
  static const BoardPhotographer photographer(TrueCamera());
  return photographer;
}

void ExpectFindsTheCamera(const Board& board, const std::string& label) {
  const Camera truth = TrueCamera();
  const PrintedBoard printed(board);
  Rng rng(3);
  std::vector<BoardView> views;
  for (int i = 0; i < 9; ++i) {
    const Image picture =
        Photographer().Take(printed, RandomPose(printed, truth, 0.7, &rng), 2, 100 + i);
    BoardView view = FindBoard(board, picture, std::to_string(i));
    if (view.found()) views.push_back(view);
  }
  ASSERT_GE(views.size(), 8u);
  const auto calibration = CalibrateCamera(views, truth.width, truth.height, {});
  ASSERT_TRUE(calibration.has_value());
  const Intrinsics &found = calibration->camera.intrinsics, &t = truth.intrinsics;
  EXPECT_NEAR(found.fx / t.fx, 1, 0.005);
  EXPECT_NEAR(found.fy / t.fy, 1, 0.005);
  EXPECT_NEAR(found.cx, t.cx, 2);
  EXPECT_NEAR(found.cy, t.cy, 2);
  EXPECT_LT(calibration->reprojection_rms, 0.3);
  EXPECT_LT(calibration->sd.fx / t.fx, 0.005);
  testing::Test::RecordProperty(
      label, "fx " + std::to_string(100 * (found.fx / t.fx - 1)) + " %, sd " +
                 std::to_string(100 * calibration->sd.fx / t.fx) + " %, rms " +
                 std::to_string(calibration->reprojection_rms) + " px, worst ray " +
                 std::to_string(WorstRayError(truth, calibration->camera)) + " px");
}
TEST(Calibrate, FindsTheCameraFromChessboardPictures) {
  ExpectFindsTheCamera(kChessboard, "chessboard");
}

TEST(Calibrate, FindsTheCameraFromCharucoPictures) { ExpectFindsTheCamera(kCharuco, "charuco"); }

TEST(FindBoard, PutsCornersWhereTheCameraSeesThem) {
  const Camera truth = TrueCamera();
  for (const Board& board : {kChessboard, kCharuco}) {
    const PrintedBoard printed(board);
    Rng rng(7);
    const Rigid3d cam_from_board = RandomPose(printed, truth, 0.4, &rng);
    const BoardView view =
        FindBoard(board, Photographer().Take(printed, cam_from_board, 2, 1), "x");
    ASSERT_TRUE(view.found());
    // Which corner is called first, and which way y runs, is the board's business: match by place.
    for (const Vec2d& pixel : view.pixels) {
      double nearest = 1e9;
      for (int row = 0; row <= board.rows; ++row) {
        for (int column = 0; column <= board.columns; ++column) {
          const Vec3d p{column * board.square, row * board.square, 0};
          const Vec2d expected = Project(truth.intrinsics, cam_from_board * p);
          nearest = std::min(nearest, std::hypot(pixel.x - expected.x, pixel.y - expected.y));
        }
      }
      EXPECT_LT(nearest, 0.2);
    }
  }
}

TEST(FindBoard, FindsNoneWhereThereIsNone) {
  Image image(320, 240);
  Rng rng(1);
  for (auto& value : image.bgr) value = static_cast<std::uint8_t>(rng.Below(256));
  EXPECT_FALSE(FindBoard(kChessboard, image, "noise").found());
  EXPECT_FALSE(FindBoard(kCharuco, image, "noise").found());
  EXPECT_FALSE(FindBoard(kChessboard, Image(1, 1), "dot").found());
}

TEST(FindBoard, RefusesBoardsThatCannotBe) {
  const Image image(64, 64);
  Board board = kChessboard;
  board.columns = 1;
  EXPECT_THROW(FindBoard(board, image, "x"), std::invalid_argument);
  board = kCharuco;
  board.marker = 0.04;
  EXPECT_THROW(FindBoard(board, image, "x"), std::invalid_argument);
  board = kCharuco;
  board.dictionary = "DICT_4X4_60";
  EXPECT_THROW(FindBoard(board, image, "x"), std::invalid_argument);
  board = kCharuco;
  board.columns = 30;
  EXPECT_THROW(FindBoard(board, image, "x"), std::invalid_argument);  // 50 markers do not suffice
}

TEST(CalibrateCamera, IsExactOnExactCorners) {
  const Camera truth = TrueCamera();
  const auto calibration =
      CalibrateCamera(ProjectedViews(truth, 12, 0.7, 0, 5), truth.width, truth.height, {});
  ASSERT_TRUE(calibration.has_value());
  EXPECT_NEAR(calibration->camera.intrinsics.fx / truth.intrinsics.fx, 1, 1e-5);
  EXPECT_LT(WorstRayError(truth, calibration->camera), 0.02);
  EXPECT_LT(calibration->reprojection_rms, 1e-3);
}

// The standard deviations are those of the estimates over repeated noise.
TEST(CalibrateCamera, StandardDeviationsAreHonest) {
  const Camera truth = TrueCamera();
  double sum_of_squares = 0, profile_squares = 0;
  constexpr int kTrials = 25;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto calibration = CalibrateCamera(ProjectedViews(truth, 8, 0.7, 0.3, 100 + trial),
                                             truth.width, truth.height, {.distortion = 4});
    ASSERT_TRUE(calibration.has_value());
    const double z = (calibration->camera.intrinsics.fx - truth.intrinsics.fx) / calibration->sd.fx;
    sum_of_squares += z * z;
    const double profile_z =
        (calibration->camera.intrinsics.fx / truth.intrinsics.fx - 1) / calibration->focal_sd;
    profile_squares += profile_z * profile_z;
    EXPECT_NEAR(calibration->reprojection_rms, 0.3 * std::sqrt(2), 0.05);
    EXPECT_EQ(calibration->sd.distortion[4], 0);
  }
  const double sd_of_z = std::sqrt(sum_of_squares / kTrials);  // 1 +- 0.14
  EXPECT_GT(sd_of_z, 0.7);
  EXPECT_LT(sd_of_z, 1.45);
  EXPECT_NEAR(std::sqrt(profile_squares / kTrials), 1, 0.35);
  RecordProperty("sd_of_z", std::to_string(sd_of_z));
}

TEST(CalibrateCamera, FitsEveryDistortionModel) {
  const Camera truth = TrueCamera();
  const auto views = ProjectedViews(truth, 8, 0.7, 0.02, 6);
  for (const int count : {4, 5, 8, 12}) {
    const auto calibration =
        CalibrateCamera(views, truth.width, truth.height, {.distortion = count});
    ASSERT_TRUE(calibration.has_value()) << count;
    EXPECT_NEAR(calibration->camera.intrinsics.fx / truth.intrinsics.fx, 1, 0.002) << count;
    const auto& d = calibration->camera.intrinsics.distortion;
    EXPECT_TRUE(std::all_of(d.begin() + count, d.end(), [](double c) { return c == 0; })) << count;
  }
  const auto none = CalibrateCamera(views, truth.width, truth.height, {.distortion = 0});
  ASSERT_TRUE(none.has_value());
  EXPECT_EQ(none->camera.intrinsics.distortion, (std::array<double, 12>{}));
  EXPECT_GT(none->reprojection_rms, 0.2);  // and says that the lens is not that simple
  EXPECT_THROW(CalibrateCamera(views, truth.width, truth.height, {.distortion = 7}),
               std::invalid_argument);
}

TEST(CalibrateCamera, DropsAViewThatIsWrong) {
  const Camera truth = TrueCamera();
  auto views = ProjectedViews(truth, 12, 0.7, 0.05, 8);
  Rng rng(9);
  for (Vec2d& p : views[4].pixels) p = {p.x + 6 * rng.Normal(), p.y + 6 * rng.Normal()};
  const auto calibration = CalibrateCamera(views, truth.width, truth.height, {});
  ASSERT_TRUE(calibration.has_value());
  EXPECT_FALSE(calibration->view_kept[4]);
  EXPECT_GT(calibration->view_rms[4], 3);
  EXPECT_EQ(std::count(calibration->view_kept.begin(), calibration->view_kept.end(), true), 11);
  EXPECT_NEAR(calibration->camera.intrinsics.fx / truth.intrinsics.fx, 1, 0.003);
}

// Boards that all face the camera leave the focal length open: no camera, or one that says so.
TEST(CalibrateCamera, SaysWhenTheViewsDetermineNothing) {
  const Camera truth = TrueCamera();
  const auto calibration = CalibrateCamera(ProjectedViews(truth, 8, 0.0, 0.1, 12), truth.width,
                                           truth.height, {.distortion = 4});
  EXPECT_FALSE(calibration.has_value());
  EXPECT_THROW(CalibrateCamera(ProjectedViews(truth, 3, 0.7, 0.1, 1), 800, 600, {}),
               std::invalid_argument);
}

TEST(DropRepeats, KeepsTheSharpestOfEach) {
  const auto views = ProjectedViews(TrueCamera(), 3, 0.7, 0, 22);
  auto again = views;
  for (BoardView& view : again) {
    view.name = "again";
    for (Vec2d& p : view.pixels) p.x += 0.5;
  }
  again.insert(again.begin(), views.begin(), views.end());
  const auto kept = DropRepeats(again);
  ASSERT_EQ(kept.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(kept[i].pixels, views[i].pixels);
  for (BoardView& view : again) view.sharpness = view.name == "again" ? 2 : 1;
  for (const BoardView& view : DropRepeats(again)) EXPECT_EQ(view.name, "again");
}

TEST(SelectViews, TakesTheDifferentOnes) {
  const Camera truth = TrueCamera();
  auto views = ProjectedViews(truth, 6, 0.7, 0, 20);
  for (std::size_t i = 0; i < views.size(); ++i) views[i].name = "different";
  const auto still = ProjectedViews(truth, 1, 0.1, 0, 21).front();
  for (int k = 0; k < 50; ++k) {
    views.insert(views.begin() + k % 7, still);
    views[static_cast<std::size_t>(k % 7)].name = "still";
  }
  const auto selected = SelectViews(views, 7);
  ASSERT_EQ(selected.size(), 7u);
  EXPECT_EQ(std::count_if(selected.begin(), selected.end(),
                          [](const BoardView& v) { return v.name == "different"; }),
            6);
  EXPECT_EQ(SelectViews(views, 100).size(), views.size());
}

TEST(Sharpness, FallsWithBlur) {
  const Camera truth = TrueCamera();
  const PrintedBoard printed(kChessboard);
  Rng rng(2);
  const Image sharp = Photographer().Take(printed, RandomPose(printed, truth, 0.3, &rng), 0, 1);
  Image blurred = sharp;
  for (int v = 0; v < sharp.height; ++v) {
    for (int u = 4; u < sharp.width - 4; ++u) {
      int sum = 0;
      for (int k = -4; k <= 4; ++k) sum += sharp.Row(v)[3 * (u + k)];
      std::fill_n(blurred.Row(v) + 3 * u, 3, static_cast<std::uint8_t>(sum / 9));
    }
  }
  EXPECT_GT(Sharpness(sharp), 1.5 * Sharpness(blurred));
}

}  // namespace
}  // namespace flocklift
