// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/camera/projection.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "simulate/camera/camera.h"
#include "simulate/core/rng.h"

namespace flocklift {
namespace {

constexpr int kWidth = 1280, kHeight = 960;

// Coefficients in the range of real lenses, small enough that the image has no fold.
Intrinsics RandomIntrinsics(Rng* rng, int coefficients) {
  Intrinsics k;
  k.fx = rng->Uniform(1000, 2500);
  k.fy = k.fx * rng->Uniform(0.95, 1.05);
  k.cx = rng->Uniform(0.4, 0.6) * kWidth;
  k.cy = rng->Uniform(0.4, 0.6) * kHeight;
  constexpr double kLargest[12] = {0.15, 0.05, 2e-3, 2e-3, 0.02, 0.1,
                                   0.05, 0.02, 5e-3, 2e-3, 5e-3, 2e-3};
  for (int i = 0; i < coefficients; ++i) {
    k.distortion[i] = kLargest[i] * rng->Uniform(-1, 1);
  }
  return k;
}

cv::Mat CameraMatrix(const Intrinsics& k) {
  return (cv::Mat_<double>(3, 3) << k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1);
}

cv::Mat Distortion(const Intrinsics& k, int coefficients) {
  return cv::Mat(coefficients, 1, CV_64F, const_cast<double*>(k.distortion.data())).clone();
}

Vec3d RandomPointInCam(Rng* rng, const Intrinsics& k) {
  const double z = rng->Uniform(0.5, 100);
  return {z * (rng->Uniform(0, kWidth) - k.cx) / k.fx, z * (rng->Uniform(0, kHeight) - k.cy) / k.fy,
          z};
}

class AgainstOpenCv : public testing::TestWithParam<int> {};  // the number of coefficients
INSTANTIATE_TEST_SUITE_P(Models, AgainstOpenCv, testing::Values(0, 4, 5, 8, 12));

TEST_P(AgainstOpenCv, ProjectsAsProjectPointsDoes) {
  Rng rng(1, GetParam());
  double worst = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const Intrinsics k = RandomIntrinsics(&rng, GetParam());
    std::vector<cv::Point3d> points;
    for (int i = 0; i < 40; ++i) {
      const Vec3d p = RandomPointInCam(&rng, k);
      points.emplace_back(p.x, p.y, p.z);
    }
    std::vector<cv::Point2d> expected;
    cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), CameraMatrix(k), Distortion(k, GetParam()),
                      expected);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec2d pixel = Project<double>(k, {points[i].x, points[i].y, points[i].z});
      worst = std::max({worst, std::abs(pixel.x - expected[i].x) / k.fx,
                        std::abs(pixel.y - expected[i].y) / k.fy});
    }
  }
  EXPECT_LT(worst, 1e-9);
  RecordProperty("worst_disagreement", std::to_string(worst * 1e15) + "e-15");
}

TEST_P(AgainstOpenCv, UndistortsAsUndistortPointsDoes) {
  Rng rng(2, GetParam());
  double worst = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const Intrinsics k = RandomIntrinsics(&rng, GetParam());
    std::vector<cv::Point2d> pixels, expected;
    for (int i = 0; i < 40; ++i) {
      pixels.emplace_back(rng.Uniform(0, kWidth), rng.Uniform(0, kHeight));
    }
    // OpenCV iterates to a fixed point: let it go on until rounding.
    const cv::TermCriteria until_exact(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 500, 1e-14);
    cv::undistortPoints(pixels, expected, CameraMatrix(k), Distortion(k, GetParam()), cv::noArray(),
                        cv::noArray(), until_exact);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const auto ray = RayThroughPixel(k, {pixels[i].x, pixels[i].y});
      ASSERT_TRUE(ray.has_value());
      worst = std::max({worst, std::abs(ray->x - expected[i].x), std::abs(ray->y - expected[i].y)});
    }
  }
  EXPECT_LT(worst, 1e-9);
  RecordProperty("worst_disagreement", std::to_string(worst * 1e15) + "e-15");
}

TEST_P(AgainstOpenCv, RaysLeadBackToTheirPixels) {
  Rng rng(3, GetParam());
  for (int trial = 0; trial < 2000; ++trial) {
    const Intrinsics k = RandomIntrinsics(&rng, GetParam());
    const Vec2d pixel{rng.Uniform(-0.5, kWidth - 0.5), rng.Uniform(-0.5, kHeight - 0.5)};
    const auto ray = RayThroughPixel(k, pixel);
    ASSERT_TRUE(ray.has_value());
    const Vec2d back = ProjectNormalized(k, *ray);
    EXPECT_NEAR(back.x, pixel.x, 1e-9);
    EXPECT_NEAR(back.y, pixel.y, 1e-9);
  }
}

TEST(Project, ByHand) {
  Intrinsics k{100, 200, 10, 20, {}};
  const Vec2d straight = Project<double>(k, {1, 2, 4});
  EXPECT_DOUBLE_EQ(straight.x, 35);   // 100 * 1/4 + 10
  EXPECT_DOUBLE_EQ(straight.y, 120);  // 200 * 2/4 + 20
  k.distortion[0] = 0.1;              // r2 = 1: everything moves out by a tenth
  const Vec2d barrel = Project<double>(k, {0, 3, 3});
  EXPECT_DOUBLE_EQ(barrel.x, 10);
  EXPECT_DOUBLE_EQ(barrel.y, 240);
}

// Autodiff through the projection, against central differences.
TEST(Project, JetsCarryTheDerivatives) {
  using Jet = ceres::Jet<double, 3>;
  Rng rng(4);
  for (int trial = 0; trial < 100; ++trial) {
    const Intrinsics k = RandomIntrinsics(&rng, 12);
    const Vec3d p = RandomPointInCam(&rng, k);
    const Vec2<Jet> pixel = Project<Jet>(k, {Jet(p.x, 0), Jet(p.y, 1), Jet(p.z, 2)});
    const Vec2d value = Project(k, p);
    EXPECT_NEAR(pixel.x.a, value.x, 1e-9);
    EXPECT_NEAR(pixel.y.a, value.y, 1e-9);
    for (int axis = 0; axis < 3; ++axis) {
      const double h = 1e-5 * p.z;
      const Vec3d step{axis == 0 ? h : 0, axis == 1 ? h : 0, axis == 2 ? h : 0};
      const Vec2d plus = Project(k, p + step), minus = Project(k, p - step);
      const double tolerance = 1e-6 * k.fx / p.z;
      EXPECT_NEAR(pixel.x.v[axis], (plus.x - minus.x) / (2 * h), tolerance);
      EXPECT_NEAR(pixel.y.v[axis], (plus.y - minus.y) / (2 * h), tolerance);
    }
  }
}

// r'' = r (1 - 0.3 r^2) rises to 2/3 sqrt(1/0.9) at r = sqrt(1/0.9) and folds there.
TEST(RayThroughPixel, KnowsWhereTheImageFolds) {
  Intrinsics k{1000, 1000, 0, 0, {-0.3}};
  const double fold = std::sqrt(1 / 0.9), farthest = 2.0 / 3 * fold;
  for (const double share : {0.1, 0.5, 0.9, 0.99, 0.99999}) {
    const auto ray = RayThroughPixel(k, {1000 * farthest * share, 0});
    ASSERT_TRUE(ray.has_value()) << share;
    EXPECT_NEAR(1000 * ray->x * (1 - 0.3 * ray->x * ray->x), 1000 * farthest * share, 1e-9);
    EXPECT_LT(ray->x, fold);
    EXPECT_GT(ray->x, 0);
  }
  for (const double share : {1.0001, 1.5, 3.0, 100.0, -1.0001, -20.0}) {
    EXPECT_FALSE(RayThroughPixel(k, {1000 * farthest * share, 0}).has_value()) << share;
    EXPECT_FALSE(RayThroughPixel(k, {0, 1000 * farthest * share}).has_value()) << share;
  }
}

// Whatever the coefficients, a ray that is returned leads to its pixel, and is the innermost one.
TEST(RayThroughPixel, IsTheInnermostSolutionUnderStrongDistortion) {
  Rng rng(6);
  int found = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    Intrinsics k{1000, 1000, 0, 0, {}};
    k.distortion[0] = rng.Uniform(-0.8, 0.8);
    k.distortion[1] = rng.Uniform(-0.5, 0.5);
    k.distortion[4] = rng.Uniform(-0.3, 0.3);
    if (trial % 2 == 1) {
      for (int i = 5; i < 8; ++i) k.distortion[i] = rng.Uniform(-0.5, 0.5);
    }
    const double target = rng.Uniform(0, 1.2);
    // Brute force on the radius: the first crossing, unless the curve turns or has a pole before.
    double innermost = -1, last = 0;
    for (double r = 1e-4; r < 20; r += 1e-4) {
      const double q = r * r;
      const auto& d = k.distortion;
      const double below = 1 + q * (d[5] + q * (d[6] + q * d[7]));
      const double image = r * (1 + q * (d[0] + q * (d[1] + q * d[4]))) / below;
      if (below <= 0 || image <= last) break;
      if (image >= target) {
        innermost = r;
        break;
      }
      last = image;
    }
    const double angle = rng.Uniform(0, 6.28);
    const auto ray =
        RayThroughPixel(k, {1000 * target * std::cos(angle), 1000 * target * std::sin(angle)});
    // Within a hair of a fold or pole, and beyond 5 times the focal length, either answer will do.
    if (innermost < 0 && std::abs(last - target) < 1e-5) continue;
    if (innermost > 5) continue;
    ASSERT_EQ(ray.has_value(), innermost >= 0) << trial << " target " << target;
    if (!ray) continue;
    ++found;
    EXPECT_NEAR(std::hypot(ray->x, ray->y), innermost, 2e-4) << trial;
  }
  EXPECT_GT(found, 1000);
}

TEST(RayThroughPixel, RefusesWhatIsNoPixel) {
  const Intrinsics k{1000, 1000, 0, 0, {0.1}};
  EXPECT_FALSE(RayThroughPixel(k, {std::nan(""), 0}).has_value());
  EXPECT_FALSE(RayThroughPixel(k, {0, INFINITY}).has_value());
}

TEST(ProjectVisible, LeavesOutWhatTheCameraCannotSee) {
  Camera camera = PinholeCamera(90, 1000, 800);
  EXPECT_TRUE(ProjectVisible(camera, {0, 0, 5}).has_value());
  EXPECT_FALSE(ProjectVisible(camera, {0, 0, -5}).has_value());   // behind
  EXPECT_FALSE(ProjectVisible(camera, {0, 0, 0}).has_value());    // in the lens
  EXPECT_TRUE(ProjectVisible(camera, {4.9, 0, 5}).has_value());   // just inside 45 degrees
  EXPECT_FALSE(ProjectVisible(camera, {5.1, 0, 5}).has_value());  // just outside
  camera.intrinsics.distortion[0] = -0.3;
  // tan 61 degrees: beyond the fold, brought back into the image by it.
  const Vec3d folded{1.8, 0, 1};
  EXPECT_TRUE(camera.Sees(Project(camera.intrinsics, folded)));
  EXPECT_FALSE(ProjectVisible(camera, folded).has_value());
}

TEST(Camera, FieldOfViewSpansTheWidth) {
  const Camera camera = PinholeCamera(60, 1920, 1080);
  const auto left = RayThroughPixel(camera.intrinsics, {-0.5, 539.5});
  EXPECT_NEAR(left->x, -std::tan(30 * 3.14159265358979 / 180), 1e-12);
  EXPECT_NEAR(left->y, 0, 1e-12);
  EXPECT_THROW(PinholeCamera(180, 1920, 1080), std::invalid_argument);
  EXPECT_THROW(PinholeCamera(50, 0, 1080), std::invalid_argument);
}

TEST(Camera, PosePerFrameFallsBackToTheFixedOne) {
  Camera camera = PinholeCamera(60, 640, 480);
  EXPECT_FALSE(camera.KnowsGravity());
  EXPECT_EQ(camera.CamFromWorld(7), Rigid3d{});
  camera.cam_from_world_per_frame = {LookAt({0, 0, 1}, {0, 1, 1}), LookAt({0, 0, 2}, {0, 1, 2})};
  EXPECT_TRUE(camera.KnowsGravity());
  EXPECT_EQ(camera.CamFromWorld(2), camera.cam_from_world_per_frame[1]);
  EXPECT_THROW(camera.CamFromWorld(3), std::invalid_argument);
  camera.cam_from_world = LookAt({0, 0, 9}, {0, 1, 9});
  EXPECT_EQ(camera.CamFromWorld(3), *camera.cam_from_world);
}

}  // namespace
}  // namespace flocklift
