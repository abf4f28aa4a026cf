// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/triangulation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flocklift {
namespace {

// The second camera stands 10 m to the right and looks left by 30 degrees.
View Beside(const Vec3d& point) {
  const double a = std::acos(-1.0) / 6;
  const Rotation3d turn = Rotation3d::FromRows({std::cos(a), 0, std::sin(a)}, {0, 1, 0},
                                               {-std::sin(a), 0, std::cos(a)});
  View view;
  view.view_from_ref = {turn, -(turn * Vec3d{10, 0, 0})};
  const Vec3d q = view.view_from_ref * point;
  view.ray = {q.x / q.z, q.y / q.z};
  return view;
}

TEST(Triangulation, RaysOfAPointMeetAtIt) {
  const Vec3d point{3, -2, 25};
  const Vec2d ray{point.x / point.z, point.y / point.z};
  const View view = Beside(point);
  EXPECT_NEAR(*TriangulatedDepth(ray, view), 25, 1e-9);
  EXPECT_NEAR(*EpipolarDistance(ray, view), 0, 1e-12);
}

// The epipolar line holds all depths: the same ray from elsewhere on it is as near; beside it not.
TEST(Triangulation, EpipolarLinesHoldAllDepths) {
  const Vec2d ray{0.12, -0.08};
  for (const double z : {5.0, 20.0, 80.0}) {
    View view = Beside({z * ray.x, z * ray.y, z});
    EXPECT_NEAR(*EpipolarDistance(ray, view), 0, 1e-12);
    view.ray.y += 0.01;
    EXPECT_GT(std::abs(*EpipolarDistance(ray, view)), 0.008);
    EXPECT_LE(std::abs(*EpipolarDistance(ray, view)), 0.01);
  }
}

TEST(Triangulation, RaysThatPartMeetNowhere) {
  View view = Beside({0, 0, 30});
  EXPECT_TRUE(TriangulatedDepth({0, 0}, view));
  EXPECT_FALSE(TriangulatedDepth({-1.5, 0}, view));  // away to the left: behind both
  // Along the line from one camera to the other the epipolar line is any.
  const Vec3d along = view.view_from_ref.Inverse().translation;
  view.view_from_ref.translation = {0, 0, 10};
  view.view_from_ref.rotation = {};
  EXPECT_FALSE(EpipolarDistance({0, 0}, view));
  EXPECT_NEAR(Norm(along), 10, 1e-12);
}

TEST(Triangulation, RaysBetweenSightings) {
  Segment segment;
  for (const double t : {0.0, 0.1, 0.9, 1.0}) {
    Sighting s;
    s.time = t;
    s.ray = {t, 2 * t};
    segment.sightings.push_back(s);
  }
  EXPECT_NEAR(RayAt(segment, 0.05)->x, 0.05, 1e-12);
  EXPECT_NEAR(RayAt(segment, 0.95)->y, 1.9, 1e-12);
  EXPECT_NEAR(RayAt(segment, 1)->x, 1, 1e-12);
  EXPECT_NEAR(RayAt(segment, 0)->x, 0, 1e-12);
  EXPECT_FALSE(RayAt(segment, 0.5));  // a gap
  EXPECT_FALSE(RayAt(segment, 1.1));
  EXPECT_FALSE(RayAt(segment, -0.1));
}

}  // namespace
}  // namespace flocklift
