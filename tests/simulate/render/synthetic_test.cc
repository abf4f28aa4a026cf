// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/synthetic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <vector>

#include "simulate/camera/projection.h"
#include "simulate/core/rng.h"
#include "simulate/render/flight.h"
#include "simulate/render/renderer.h"
#include "simulate/render/speck.h"

namespace flocklift {
namespace {

constexpr double kFps = 30;

Camera TestCamera() {
  Camera camera = PinholeCamera(40, 320, 240);
  camera.cam_from_world = LookAt({0, -30, 1.7}, {0, 0, 10});
  camera.intrinsics.distortion = {-0.1, 0.02};
  return camera;
}

// Birds that sway to and fro across the field of view, and leave it.
Trajectories SwayingBirds(int birds, int frames) {
  Trajectories t;
  for (Id id = 1; id <= birds; ++id) {
    Rng rng(77, static_cast<std::uint64_t>(id));
    const Vec3d middle{rng.Uniform(-8, 8), rng.Uniform(-10, 20), rng.Uniform(6, 14)};
    const double phase = rng.Uniform(0, 6), reach = rng.Uniform(2, 10);
    Trajectory& bird = t.trajectories.emplace_back();
    bird.id = id;
    for (int frame = 1; frame <= frames; ++frame) {
      const double angle = phase + 1.5 * frame / kFps;
      bird.points.push_back(
          {.frame = frame,
           .position = middle + Vec3d{reach * std::cos(angle), 2 * std::sin(angle), 0},
           .velocity = {},
           .world_from_body = {}});
    }
  }
  return t;
}

TEST(SyntheticTest, BoxesAreCentredOnTheProjectedPositionWhileItIsInView) {
  const Camera camera = TestCamera();
  const Trajectories truth = SwayingBirds(20, 90);
  const Tracks tracks = SynthesizeTracks(truth, {}, camera, kFps);
  std::map<std::pair<Id, int>, Detection> rows;
  for (const Tracklet& tracklet : tracks.tracklets) {
    for (const Detection& d : tracklet.detections) rows[{tracklet.id, d.frame}] = d;
  }
  std::size_t visible = 0, all = 0;
  for (const Trajectory& bird : truth.trajectories) {
    for (const TrajectoryPoint& point : bird.points) {
      ++all;
      const Vec3d in_cam = *camera.cam_from_world * point.position;
      const Vec2d pixel = Project(camera.intrinsics, in_cam);
      const bool in_view =
          pixel.x >= -0.5 && pixel.x <= 319.5 && pixel.y >= -0.5 && pixel.y <= 239.5;
      const auto row = rows.find({bird.id, point.frame});
      ASSERT_EQ(row != rows.end(), in_view) << bird.id << " " << point.frame;
      if (!in_view) continue;
      ++visible;
      EXPECT_NEAR(row->second.box.Center().x, pixel.x, 1e-9);
      EXPECT_NEAR(row->second.box.Center().y, pixel.y, 1e-9);
      EXPECT_EQ(row->second.confidence, 1);
    }
  }
  EXPECT_EQ(rows.size(), visible);
  EXPECT_GT(visible, 500U);
  EXPECT_LT(visible, all - 100);
  EXPECT_EQ(tracks.fps, kFps);
}

// The box against pixels: as wide and as high as what is dark, but for the blur of a pixel on
// either side.
TEST(SyntheticTest, BoxesAreAsLargeAsWhatTheRendererDraws) {
  const Camera camera = TestCamera();
  const Trajectories truth = SwayingBirds(1, 60);
  const Animal animal{.id = 1, .wingspan = 3, .body_length = 1.2, .wingbeat_hz = 3};
  const Tracks tracks = SynthesizeTracks(truth, {&animal, 1}, camera, kFps);
  const RenderSpec clean{.background = "plain", .noise = 0, .blur = 0, .haze = 0};
  const FlockRenderer renderer(camera, clean, kFps, 1);
  const Flight flight(truth, {&animal, 1}, camera, kFps);
  const Image empty = renderer.Render(1, 0, {});
  ASSERT_EQ(tracks.tracklets.size(), 1U);
  int compared = 0;
  for (const Detection& d : tracks.tracklets[0].detections) {
    const Box& box = d.box;
    if (box.left < 3 || box.top < 3 || box.left + box.width > 316 || box.top + box.height > 236) {
      continue;
    }
    ++compared;
    const Image image = renderer.Render(d.frame, flight.TimeOf(d.frame), flight.At(d.frame));
    double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9, area = 0;
    for (int v = 0; v < image.height; ++v) {
      for (int u = 0; u < image.width; ++u) {
        const int dark = empty.Row(v)[3 * u] - image.Row(v)[3 * u];
        area += dark / 150.0;
        if (dark < 8) continue;
        left = std::min<double>(left, u);
        right = std::max<double>(right, u);
        top = std::min<double>(top, v);
        bottom = std::max<double>(bottom, v);
      }
    }
    EXPECT_NEAR(right - left + 1, box.width, 2);
    EXPECT_NEAR(bottom - top + 1, box.height, 2);
    ASSERT_TRUE(d.shape);
    EXPECT_NEAR(area, d.shape->area, 0.1 * d.shape->area);
    EXPECT_GE(d.shape->major, d.shape->minor);
    EXPECT_GE(d.shape->angle_deg, 0);
    EXPECT_LT(d.shape->angle_deg, 180);
  }
  EXPECT_GT(compared, 20);
}

// Insects that stand in the picture, `size_px` wide.
Tracks ObserveInsects(double size_px, const Camera& camera, int threads,
                      const Scenery* scenery = nullptr) {
  Trajectories truth{.fps = kFps,
                     .has_velocity = true,
                     .has_orientation = true,
                     .has_sd_depth = false,
                     .trajectories = {}};
  std::vector<Animal> animals;
  for (Id id = 1; id <= 200; ++id) {
    Rng rng(88, static_cast<std::uint64_t>(id));
    const double depth = rng.Uniform(15, 40);
    const double u = rng.Uniform(10, 310), v = rng.Uniform(10, 230);
    const Vec3d in_cam = depth * Vec3d{(u - camera.intrinsics.cx) / camera.intrinsics.fx,
                                       (v - camera.intrinsics.cy) / camera.intrinsics.fy, 1};
    const Rotation3d world_from_body =
        WorldFromLevelBody({rng.Normal(), rng.Normal(), rng.Normal()});
    truth.trajectories.push_back(
        {.id = id,
         .points = {{.frame = 3,
                     .position = camera.CamFromWorld(3).Inverse() * in_cam,
                     .velocity = {},
                     .world_from_body = QuaternionFromRotation(world_from_body)}}});
    const double wingspan = size_px * depth / camera.intrinsics.fx;
    animals.push_back({.id = id,
                       .wingspan = wingspan,
                       .body_length = wingspan * rng.Uniform(0.4, 1),
                       .wingbeat_phase = rng.Uniform(0, 6)});
  }
  return SynthesizeTracks(truth, animals, camera, kFps, threads, scenery);
}

// What is seen of an animal goes on without a jump where tables take over from outlines.
TEST(SyntheticTest, BoxesAndShapesAreContinuousAcrossTheSizeOfASpeck) {
  const Camera camera = TestCamera();
  const Tracks below = ObserveInsects(kSpeckPx * (1 - 1e-6), camera, 1);
  const Tracks above = ObserveInsects(kSpeckPx * (1 + 1e-6), camera, 1);
  ASSERT_EQ(below.tracklets.size(), above.tracklets.size());
  ASSERT_GT(below.tracklets.size(), 150U);
  bool differs = false;
  for (std::size_t k = 0; k < below.tracklets.size(); ++k) {
    ASSERT_EQ(below.tracklets[k].id, above.tracklets[k].id);
    const Detection& a = below.tracklets[k].detections.at(0);
    const Detection& b = above.tracklets[k].detections.at(0);
    EXPECT_NEAR(a.box.Center().x, b.box.Center().x, 1e-9);
    EXPECT_NEAR(a.box.Center().y, b.box.Center().y, 1e-9);
    EXPECT_NEAR(a.box.width, b.box.width, 0.16);  // [px]
    EXPECT_NEAR(a.box.height, b.box.height, 0.16);
    EXPECT_NEAR(a.shape->major, b.shape->major, 0.1);
    EXPECT_NEAR(a.shape->area, b.shape->area, 0.04);
    differs = differs || a.box.width != b.box.width;
  }
  EXPECT_TRUE(differs);  // else both took the same way
}

TEST(SyntheticTest, SpecksAreTheSameAtAnyThreadCountAndHideBehindObstacles) {
  const Camera camera = TestCamera();
  const Tracks one = ObserveInsects(1, camera, 1), three = ObserveInsects(1, camera, 3);
  ASSERT_EQ(one.tracklets.size(), three.tracklets.size());
  for (std::size_t k = 0; k < one.tracklets.size(); ++k) {
    const Detection &a = one.tracklets[k].detections.at(0),
                    &b = three.tracklets[k].detections.at(0);
    EXPECT_EQ(a.box.left, b.box.left);
    EXPECT_EQ(a.box.height, b.box.height);
    EXPECT_EQ(a.shape->angle_deg, b.shape->angle_deg);
    EXPECT_EQ(a.visibility, 1);
  }
  // A wall 10 m away before the left half of the picture.
  const Rigid3d world_from_cam = camera.CamFromWorld(3).Inverse();
  TriangleMesh wall{.vertices = {}, .triangles = {{0, 1, 2}, {0, 2, 3}}};
  for (const Vec3d& corner :
       {Vec3d{-20, -20, 10}, Vec3d{0, -20, 10}, Vec3d{0, 20, 10}, Vec3d{-20, 20, 10}}) {
    wall.vertices.push_back(world_from_cam * corner);
  }
  Scenery scenery;
  scenery.AddObstacle(wall);
  int hidden = 0;
  for (const Tracklet& tracklet : ObserveInsects(1, camera, 1, &scenery).tracklets) {
    const Detection& seen = tracklet.detections.at(0);
    const double from_edge = seen.box.Center().x - camera.intrinsics.cx;
    if (std::abs(from_edge) < 2) continue;
    EXPECT_EQ(seen.visibility, from_edge < 0 ? 0 : 1);
    hidden += seen.visibility == 0;
  }
  EXPECT_GT(hidden, 50);
}

TEST(SyntheticTest, AnAnimalKeepsItsIdAndThreadsDoNotMatter) {
  const Camera camera = TestCamera();
  const Trajectories truth = SwayingBirds(20, 120);
  const Tracks one = SynthesizeTracks(truth, {}, camera, kFps, 1);
  const Tracks three = SynthesizeTracks(truth, {}, camera, kFps, 3);
  ASSERT_EQ(one.tracklets.size(), three.tracklets.size());
  std::set<Id> ids;
  bool returned = false;
  for (std::size_t k = 0; k < one.tracklets.size(); ++k) {
    const auto &a = one.tracklets[k].detections, &b = three.tracklets[k].detections;
    EXPECT_TRUE(ids.insert(one.tracklets[k].id).second);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].box.left, b[i].box.left);
      if (i > 0) {
        EXPECT_GT(a[i].frame, a[i - 1].frame);
        returned = returned || a[i].frame > a[i - 1].frame + 10;
      }
    }
  }
  EXPECT_TRUE(returned);
  EXPECT_TRUE(SynthesizeTracks({}, {}, camera, kFps).tracklets.empty());
}

// Many rows of one box.
Tracks Standing(int birds, int frames) {
  Tracks tracks;
  for (Id id = 1; id <= birds; ++id) {
    Tracklet& tracklet = tracks.tracklets.emplace_back();
    tracklet.id = id;
    for (int frame = 5; frame < 5 + frames; ++frame) {
      tracklet.detections.push_back({.frame = frame,
                                     .box = Box::Around({100, 50}, 20, 10),
                                     .confidence = 1,
                                     .shape = Shape{18, 6, 30, 90}});
    }
  }
  return tracks;
}

TEST(SyntheticTest, NoiseHasItsStatistics) {
  const ObservationNoise noise{.position_sd = 0.7, .size_sd = 0.1, .miss = 0.15, .clutter = 0};
  const Tracks noisy = SynthesizeNoise(noise, 3, Standing(100, 100));
  double n = 0, du = 0, du2 = 0, dv2 = 0, log_size = 0, log_size2 = 0;
  for (const Tracklet& tracklet : noisy.tracklets) {
    for (const Detection& d : tracklet.detections) {
      const Vec2d center = d.box.Center();
      const double scale = std::log(d.box.width / 20);
      n += 1;
      du += center.x - 100;
      du2 += std::pow(center.x - 100, 2);
      dv2 += std::pow(center.y - 50, 2);
      log_size += scale;
      log_size2 += scale * scale;
      EXPECT_NEAR(d.box.height / 10, d.box.width / 20, 1e-9);
      EXPECT_NEAR(d.shape->major / 18, d.box.width / 20, 1e-9);
      EXPECT_NEAR(d.shape->area / 90, std::pow(d.box.width / 20, 2), 1e-9);
    }
  }
  EXPECT_NEAR(n / 1e4, 0.85, 0.015);
  EXPECT_NEAR(du / n, 0, 0.03);
  EXPECT_NEAR(std::sqrt(du2 / n), 0.7, 0.02);
  EXPECT_NEAR(std::sqrt(dv2 / n), 0.7, 0.02);
  EXPECT_NEAR(log_size / n, 0, 0.005);
  EXPECT_NEAR(std::sqrt(log_size2 / n), 0.1, 0.004);
}

TEST(SyntheticTest, NoNoiseChangesNothingAndRowsAreIndependent) {
  const Tracks truth = Standing(3, 20);
  const ObservationNoise none{.position_sd = 0, .size_sd = 0, .miss = 0, .clutter = 0};
  const Tracks same = SynthesizeNoise(none, 3, truth);
  ASSERT_EQ(same.tracklets.size(), 3U);
  for (const Tracklet& tracklet : same.tracklets) {
    ASSERT_EQ(tracklet.detections.size(), 20U);
    for (const Detection& d : tracklet.detections) EXPECT_NEAR(d.box.left, 90, 1e-12);
  }
  // A bird's noise does not depend on who else is there.
  Tracks alone = truth;
  alone.tracklets.erase(alone.tracklets.begin());
  const ObservationNoise noise{.miss = 0.3};
  const Tracks with = SynthesizeNoise(noise, 3, truth), without = SynthesizeNoise(noise, 3, alone);
  const auto& a = with.tracklets[2].detections;
  const auto& b = without.tracklets[1].detections;
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k].box.left, b[k].box.left);
  EXPECT_THROW(SynthesizeNoise({.miss = 1.5}, 3, truth), std::invalid_argument);
}

TEST(SyntheticTest, DetectionsHaveClutterAndNoIds) {
  const Camera camera = TestCamera();
  const ObservationNoise noise{.position_sd = 0, .size_sd = 0, .miss = 0.1, .clutter = 3};
  const auto frames = SynthesizeDetections(noise, 5, camera, Standing(4, 500));
  ASSERT_EQ(frames.size(), 500U);
  double real = 0, clutter = 0, mean_u = 0;
  int first_is_clutter = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    EXPECT_EQ(frames[k].frame, static_cast<int>(k) + 5);
    if (!frames[k].detections.empty()) first_is_clutter += frames[k].detections[0].confidence < 1;
    for (const Detection& d : frames[k].detections) {
      EXPECT_EQ(d.frame, frames[k].frame);
      EXPECT_GE(d.confidence, kMeasuredConfidence);
      EXPECT_TRUE(camera.Sees(d.box.Center()));
      (d.confidence == 1 ? real : clutter) += 1;
      if (d.confidence < 1) mean_u += d.box.Center().x;
    }
  }
  EXPECT_NEAR(real / 500, 3.6, 0.15);
  EXPECT_NEAR(clutter / 500, 3, 0.25);
  EXPECT_NEAR(mean_u / clutter, 159.5, 8);
  EXPECT_GT(first_is_clutter, 100);  // mixed, not appended
  EXPECT_LT(first_is_clutter, 400);
}

}  // namespace
}  // namespace flocklift
