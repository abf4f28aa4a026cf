// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/scenery.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "simulate/render/film.h"
#include "simulate/render/visibility.h"
#include "simulate/synthetic.h"

namespace flocklift {
namespace {

constexpr double kFps = 10;

// A wall 20 m away, over the left half of what the camera sees.
TriangleMesh Wall() {
  return {{{-30, -30, 20}, {0, -30, 20}, {0, 30, 20}, {-30, 30, 20}}, {{0, 1, 2}, {0, 2, 3}}};
}

TEST(SceneryTest, TheSettingFollowsTheTime) {
  Scenery scenery;
  EXPECT_TRUE(scenery.empty());
  scenery.AddObstacle(Wall());
  scenery.AddGoal([](double time) { return Vec3d{time, 0, 9}; }, 2);
  scenery.AddPath({{0, 0, 5}, {1, 0, 5}});
  scenery.AddSurface(MovingTetrahedra(
      2, {1, 2, 3}, [](int frame, std::vector<Vec3d>* vertices, std::vector<Vec3d>* velocities) {
        vertices->assign(8, Vec3d{0, 0, double(frame)});
        velocities->assign(8, Vec3d{0, 0, 10});
      }));
  EXPECT_FALSE(scenery.empty());
  int calls = 0;
  scenery.With(7, 1.5, [&](const Setting& setting) {
    ++calls;
    ASSERT_EQ(setting.balls.size(), 1U);
    EXPECT_EQ(setting.balls[0].center, (Vec3d{1.5, 0, 9}));
    EXPECT_EQ(setting.balls[0].radius, 2);
    EXPECT_EQ(setting.strokes.size(), 2U);  // the path, and the goal's ring
    ASSERT_EQ(setting.surfaces.size(), 2U);
    EXPECT_EQ(setting.surfaces[0].normals.size(), 6U);
    EXPECT_EQ(setting.surfaces[1].triangles.size(), 8U);
    EXPECT_EQ(setting.surfaces[1].vertices[3].z, 7);
    EXPECT_EQ(setting.surfaces[1].velocities[3].z, 10);
  });
  EXPECT_EQ(calls, 1);
  EXPECT_THROW(scenery.AddGoal([](double) { return Vec3d{}; }, 0), std::invalid_argument);
}

TEST(SceneryTest, TheGroundHasAReadableNumberOfLines) {
  for (const double side : {0.05, 3.0, 40.0, 600.0}) {
    Scenery scenery;
    scenery.AddGround({{0, 0, 0}, {side, side, 1}});
    scenery.With(1, 0, [&](const Setting& setting) {
      EXPECT_GE(setting.strokes.size(), 2U * 6) << side;
      EXPECT_LE(setting.strokes.size(), 2U * 61) << side;
    });
  }
  EXPECT_THROW(Scenery().AddGround({}), std::invalid_argument);
}

// Animals that fly level across the image at depth `depth`, from left to right.
Trajectories Crossing(double depth) {
  Trajectories t;
  t.trajectories.push_back({.id = 1, .points = {}});
  for (int frame = 1; frame <= 21; ++frame) {
    t.trajectories[0].points.push_back({.frame = frame,
                                        .position = {0.05 * depth * (frame - 11), 0, depth},
                                        .velocity = {},
                                        .world_from_body = {}});
  }
  return t;
}

TEST(SceneryTest, TrueTracksSayWhatObstaclesHide) {
  const Camera camera = PinholeCamera(70, 200, 120);
  Scenery scenery;
  scenery.AddObstacle(Wall());
  for (const double depth : {10.0, 40.0}) {
    const Tracks open = SynthesizeTracks(Crossing(depth), {}, camera, kFps);
    const Tracks hidden = SynthesizeTracks(Crossing(depth), {}, camera, kFps, 1, &scenery);
    const Tracks threads = SynthesizeTracks(Crossing(depth), {}, camera, kFps, 3, &scenery);
    ASSERT_EQ(hidden.tracklets.size(), 1U);
    const auto& rows = hidden.tracklets[0].detections;
    ASSERT_EQ(rows.size(), 21U);  // hidden or not
    for (std::size_t k = 0; k < rows.size(); ++k) {
      EXPECT_EQ(open.tracklets[0].detections[k].visibility, 1);
      EXPECT_EQ(rows[k].box.left, open.tracklets[0].detections[k].box.left);
      EXPECT_EQ(rows[k].visibility, threads.tracklets[0].detections[k].visibility);
      if (depth < 20 || k > 11) {
        EXPECT_NEAR(rows[k].visibility, 1, 1e-6) << k;
      } else if (k < 9) {
        EXPECT_NEAR(rows[k].visibility, 0, 1e-6) << k;
      }
    }
    EXPECT_NEAR(rows[10].visibility, depth > 20 ? 0.5 : 1, 0.15);
  }
}

TEST(SceneryTest, AFrameOfTheFilmShowsIt) {
  const Camera camera = PinholeCamera(70, 200, 120);
  Scenery scenery;
  scenery.AddObstacle(Wall());
  RenderSpec spec{.background = "plain", .noise = 0, .blur = 0.3, .haze = 0};
  FilmOptions options{.fps = kFps, .frames = 21};
  const Image bare = DrawFrame({}, {}, camera, spec, options, 3);
  options.scenery = &scenery;
  const Image walled = DrawFrame({}, {}, camera, spec, options, 3);
  const Image bird = DrawFrame(Crossing(40), {}, camera, spec, options, 3);
  EXPECT_NE(bare.bgr, walled.bgr);
  EXPECT_EQ(bird.bgr, walled.bgr);  // behind the wall
  EXPECT_NE(DrawFrame(Crossing(40), {}, camera, spec, options, 18).bgr, walled.bgr);
}

}  // namespace
}  // namespace flocklift
