// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/marks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>
#include <vector>

#include "simulate/camera/projection.h"

namespace flocklift {
namespace {

const Camera kCamera = PinholeCamera(60, 160, 120);

// What is left of the ground under patches that are laid over one after the other.
std::vector<double> CoverOf(const std::vector<Patch>& patches) {
  std::vector<double> open(160 * 120, 1.0);
  for (const Patch& patch : patches) {
    for (int row = 0; row < patch.mask.height(); ++row) {
      for (int u = 0; u < patch.mask.width(); ++u) {
        open[static_cast<std::size_t>((patch.mask.top() + row) * 160 + patch.mask.left() + u)] *=
            1 - patch.mask.Row(row)[u] * patch.paint.opacity;
      }
    }
  }
  for (double& share : open) share = 1 - share;
  return open;
}

double Sum(const std::vector<double>& cover) {
  double sum = 0;
  for (const double share : cover) sum += share;
  return sum;
}

Vec3d At(double u, double v, double depth) {
  return depth * Vec3d{(u - kCamera.intrinsics.cx) / kCamera.intrinsics.fx,
                       (v - kCamera.intrinsics.cy) / kCamera.intrinsics.fy, 1};
}

LineCover EmptyCover() { return LineCover(160 * 120, 0.0F); }

TEST(MarksTest, ALineCoversItsLengthTimesItsWidthWithoutBeads) {
  const Stroke stroke{.points = {At(20, 31.3, 5), At(90, 31.3, 9), At(140, 31.3, 9)},
                      .color = {},
                      .width_px = 1.5,
                      .opacity = 1};
  LineCover line_cover = EmptyCover();
  std::vector<Patch> patches;
  AddStroke(stroke, kCamera, {}, 0, &line_cover, &patches);
  EXPECT_GT(patches.size(), 4U);
  EXPECT_EQ(line_cover, EmptyCover());
  const std::vector<double> cover = CoverOf(patches);
  EXPECT_NEAR(Sum(cover), 120 * 1.5, 0.2);
  for (int u = 24; u < 136; ++u) {
    double column = 0;
    for (int v = 0; v < 120; ++v) column += cover[static_cast<std::size_t>(160 * v + u)];
    EXPECT_NEAR(column, 1.5, 1e-3) << u;
  }
  for (std::size_t k = 1; k < patches.size(); ++k) {
    EXPECT_GE(patches[k - 1].paint.depth, patches[k].paint.depth);
  }
  EXPECT_NEAR(patches.front().paint.depth, 9, 0.5);
  EXPECT_NEAR(patches.back().paint.depth, 5, 0.5);
}

TEST(MarksTest, ALineEndsAtTheNearPlaneAndAtTheRim) {
  LineCover line_cover = EmptyCover();
  std::vector<Patch> patches;
  const auto count = [&](const Vec3d& a, const Vec3d& b) {
    patches.clear();
    AddStroke({.points = {a, b}, .color = {}}, kCamera, {}, 0, &line_cover, &patches);
    return patches.size();
  };
  EXPECT_EQ(count({0, 0, -5}, {1, 0, -1}), 0U);
  EXPECT_EQ(count({1000, 0, 5}, {1000, 1, 5}), 0U);
  EXPECT_GT(count({0, 1, -5}, {0, 1, 500}), 10U);  // from under the camera to far away
  EXPECT_LT(count({-1e5, 0, 5}, {1e5, 0, 5}), 30U);
}

TEST(MarksTest, ALineIsBentByTheLens) {
  Camera bent = kCamera;
  bent.intrinsics.distortion = {-0.3, 0.1, 0, 0};
  LineCover line_cover = EmptyCover();
  std::vector<Patch> patches;
  const Vec3d a = At(10, 10, 5), b = At(150, 10, 5), middle = 0.5 * (a + b);
  AddStroke({.points = {a, b}, .color = {}, .width_px = 2}, bent, {}, 0, &line_cover, &patches);
  const std::vector<double> cover = CoverOf(patches);
  for (const Vec3d& point : {middle, 0.75 * a + 0.25 * b}) {
    const Vec2d pixel = Project(bent.intrinsics, point);
    const auto at = static_cast<std::size_t>(160 * std::lround(pixel.y) + std::lround(pixel.x));
    EXPECT_GT(cover[at], 0.9);
  }
}

TEST(MarksTest, ABallHasTheAreaOfItsOutline) {
  const TintedBall ball{.center = {0.3, -0.2, 8}, .radius = 1.5, .color = {}, .opacity = 0.5};
  std::vector<Patch> patches;
  AddBall(ball, kCamera, {}, 0, &patches);
  ASSERT_EQ(patches.size(), 1U);
  // Every pixel by its ray: its distance from the centre.
  double expected = 0;
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      const Vec3d ray = Normalized(At(u, v, 1));
      expected += Norm(Cross(ray, ball.center)) < ball.radius ? 0.5 : 0;
    }
  }
  EXPECT_NEAR(Sum(CoverOf(patches)), expected, 0.01 * expected);
  EXPECT_GT(patches[0].paint.depth, 8 - 1.5);
  EXPECT_LT(patches[0].paint.depth, 8);
  patches.clear();
  AddBall({.center = {0, 0, 1}, .radius = 1.5, .color = {}}, kCamera, {}, 0, &patches);
  AddBall({.center = {0, 0, -8}, .radius = 1.5, .color = {}}, kCamera, {}, 0, &patches);
  EXPECT_TRUE(patches.empty());
}

TEST(MarksTest, HazeTakesContrast) {
  std::vector<Patch> patches;
  const TintedBall ball{.center = {0, 0, 40}, .radius = 0.1, .color = {}, .opacity = 0.5};
  AddBall(ball, kCamera, {}, 20, &patches);
  EXPECT_NEAR(patches.at(0).paint.opacity, 0.5 * std::exp(-2.0), 1e-4);
}

TEST(MarksTest, GridRingAndBox) {
  const Region region{{-1.5, 0, 2}, {1.5, 2, 9}};
  const std::vector<Stroke> grid = GroundGrid(region, 1, {}, 1);
  ASSERT_EQ(grid.size(), 3U + 3U);  // x = -1, 0, 1 and y = 0, 1, 2
  EXPECT_EQ(grid[0].points, (std::vector<Vec3d>{{-1, 0, 2}, {-1, 2, 2}}));
  EXPECT_EQ(grid[5].points, (std::vector<Vec3d>{{-1.5, 2, 2}, {1.5, 2, 2}}));
  EXPECT_THROW(GroundGrid(region, 0, {}, 1), std::invalid_argument);

  const Vec3d center{1, 2, 3}, axis{0.6, 0, 0.8};
  const Stroke ring = Ring(center, 2, axis, {}, 1, 1);
  EXPECT_EQ(ring.points.front(), ring.points.back());
  for (const Vec3d& p : ring.points) {
    EXPECT_NEAR(Norm(p - center), 2, 1e-12);
    EXPECT_NEAR(Dot(p - center, axis), 0, 1e-12);
  }

  const std::vector<Stroke> edges = BoxEdges(region, {}, 1, 1);
  ASSERT_EQ(edges.size(), 12U);
  std::multiset<double> lengths;
  for (const Stroke& edge : edges) lengths.insert(Norm(edge.points[1] - edge.points[0]));
  EXPECT_EQ(lengths, (std::multiset<double>{2, 2, 2, 2, 3, 3, 3, 3, 7, 7, 7, 7}));
}

}  // namespace
}  // namespace flocklift
