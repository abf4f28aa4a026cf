// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/tetrahedra_tracks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "simulate/camera/projection.h"
#include "simulate/core/rng.h"

namespace flocklift {
namespace {

constexpr double kFps = 30;
const std::vector<Id> kIds = {3, 8, 20, 21};

Camera TestCamera() {
  Camera camera = PinholeCamera(40, 640, 480);
  camera.cam_from_world = LookAt({0, -12, 2}, {0, 0, 2});
  return camera;
}

// Each sways across the view and leaves it; the last is a needle along the line of sight.
std::vector<Vec3d> CornersAt(int frame) {
  std::vector<Vec3d> corners;
  for (std::size_t k = 0; k + 1 < kIds.size(); ++k) {
    Rng rng(9, k);
    const Vec3d middle{0.2 * frame - 5, 2.0 * static_cast<double>(k), 2};
    for (int c = 0; c < 4; ++c) {
      corners.push_back(middle + Vec3d{rng.Normal(), rng.Normal(), rng.Normal()});
    }
  }
  for (int c = 0; c < 4; ++c) corners.push_back({0, 0.1 * c, 2});
  return corners;
}

Vec3d Middle(const std::vector<Vec3d>& corners, std::size_t k) {
  return 0.25 * (corners[4 * k] + corners[4 * k + 1] + corners[4 * k + 2] + corners[4 * k + 3]);
}

const Tracklet* Find(const Tracks& tracks, Id id) {
  for (const Tracklet& t : tracks.tracklets) {
    if (t.id == id) return &t;
  }
  return nullptr;
}

TEST(TetrahedraTracks, ABoxHoldsTheCornersWhileTheMiddleIsInView) {
  const Camera camera = TestCamera();
  const Tracks tracks = SynthesizeTetrahedraTracks(kIds, &CornersAt, {1, 60}, camera, kFps);
  int rows = 0, out_of_view = 0;
  for (std::size_t k = 0; k + 1 < kIds.size(); ++k) {
    const Tracklet* const track = Find(tracks, kIds[k]);
    ASSERT_NE(track, nullptr);
    auto next = track->detections.begin();
    for (int frame = 1; frame <= 60; ++frame) {
      const std::vector<Vec3d> corners = CornersAt(frame);
      const auto image = [&](const Vec3d& p) {
        return Project(camera.intrinsics, *camera.cam_from_world * p);
      };
      const Vec2d center = image(Middle(corners, k));
      if (!camera.Sees(center)) {
        ++out_of_view;
        continue;
      }
      ASSERT_NE(next, track->detections.end());
      ASSERT_EQ(next->frame, frame);
      double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
      for (std::size_t c = 4 * k; c < 4 * k + 4; ++c) {
        const Vec2d p = image(corners[c]);
        left = std::min(left, p.x);
        right = std::max(right, p.x);
        top = std::min(top, p.y);
        bottom = std::max(bottom, p.y);
      }
      EXPECT_NEAR(next->box.width, right - left, 1e-9);
      EXPECT_NEAR(next->box.height, bottom - top, 1e-9);
      EXPECT_NEAR(next->box.Center().x, center.x, 1e-9);
      EXPECT_NEAR(next->box.Center().y, center.y, 1e-9);
      ASSERT_TRUE(next->shape);
      EXPECT_LE(next->shape->area, next->box.width * next->box.height);
      EXPECT_GT(next->shape->area, 0);
      ++next;
      ++rows;
    }
    EXPECT_EQ(next, track->detections.end());
  }
  EXPECT_GT(rows, 60);
  EXPECT_GT(out_of_view, 10);
  EXPECT_EQ(Find(tracks, 21), nullptr);  // the needle has no area
}

TEST(TetrahedraTracks, AWallHidesWhatIsBehindIt) {
  Scenery scenery;
  TriangleMesh wall;  // between the first tetrahedron and the others
  wall.vertices = {{-20, 1, -20}, {20, 1, -20}, {20, 1, 20}, {-20, 1, 20}};
  wall.triangles = {{0, 1, 2}, {0, 2, 3}};
  scenery.AddObstacle(wall);
  const std::vector<Id> ids = {1, 2};
  const auto corners_at = [](int /*frame*/) -> std::vector<Vec3d> {
    std::vector<Vec3d> corners;
    for (const double y : {0.0, 3.0}) {
      for (const Vec3d& p :
           {Vec3d{0, 0, 0}, Vec3d{0.4, 0, 0}, Vec3d{0, 0.4, 0}, Vec3d{0, 0, 0.4}}) {
        corners.push_back(p + Vec3d{0, y, 2});
      }
    }
    return corners;
  };
  const Tracks tracks =
      SynthesizeTetrahedraTracks(ids, corners_at, {1, 2}, TestCamera(), kFps, 1, &scenery);
  ASSERT_EQ(tracks.tracklets.size(), 2u);
  for (const Detection& d : tracks.tracklets[0].detections) EXPECT_EQ(d.visibility, 1);
  for (const Detection& d : tracks.tracklets[1].detections) EXPECT_EQ(d.visibility, 0);
}

TEST(TetrahedraTracks, TheSameAtAnyThreadCount) {
  const Camera camera = TestCamera();
  const Tracks one = SynthesizeTetrahedraTracks(kIds, &CornersAt, {1, 90}, camera, kFps, 1);
  const Tracks two = SynthesizeTetrahedraTracks(kIds, &CornersAt, {1, 90}, camera, kFps, 2);
  ASSERT_EQ(one.tracklets.size(), two.tracklets.size());
  for (std::size_t k = 0; k < one.tracklets.size(); ++k) {
    ASSERT_EQ(one.tracklets[k].detections.size(), two.tracklets[k].detections.size());
    for (std::size_t d = 0; d < one.tracklets[k].detections.size(); ++d) {
      EXPECT_EQ(one.tracklets[k].detections[d].box.left, two.tracklets[k].detections[d].box.left);
    }
  }
}

}  // namespace
}  // namespace flocklift
