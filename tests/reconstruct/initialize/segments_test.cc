// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/segments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulate/camera/projection.h"
#include "tests/reconstruct/circling_flock.h"

namespace flocklift {
namespace {

Detection At(int frame, Vec2d pixel, double confidence = 1) {
  Detection detection;
  detection.frame = frame;
  detection.box = Box::Around(pixel, 12, 5);
  detection.confidence = confidence;
  return detection;
}

TEST(Segments, RaysAndSizesByHand) {
  Camera camera = PinholeCamera(90, 1001, 501);  // f = 500.5, centre (500, 250)
  camera.intrinsics.cx = 500;
  camera.intrinsics.cy = 250;
  const double f = camera.intrinsics.fx;
  Tracks tracks;
  tracks.tracklets = {{4, {At(3, {500 + f / 2, 250}), At(5, {500, 250 - f / 4}, 0.2)}}};
  tracks.tracklets[0].detections[0].box = Box::Around({500 + f / 2, 250}, 12, 5);
  const Segments s = MakeSegments({}, tracks, camera, 10);
  ASSERT_EQ(s.segments.size(), 1u);
  EXPECT_EQ(s.segments[0].id, 4);
  EXPECT_EQ(s.rows, 2);
  const Sighting& measured = s.segments[0].sightings[0];
  EXPECT_NEAR(measured.ray.x, 0.5, 1e-9);
  EXPECT_NEAR(measured.ray.y, 0, 1e-9);
  EXPECT_EQ(measured.time, 0);
  EXPECT_NEAR(*measured.log_size, std::log(13 / f), 1e-6);
  EXPECT_NEAR(measured.ray_sd, 0.25 / f, 1e-8);
  const Sighting& interpolated = s.segments[0].sightings[1];
  EXPECT_NEAR(interpolated.time, 0.2, 1e-12);
  EXPECT_NEAR(interpolated.ray.y, -0.25, 1e-9);
  EXPECT_FALSE(interpolated.log_size);
  EXPECT_GT(interpolated.ray_sd, 3 * measured.ray_sd);
}

TEST(Segments, DistortionIsTakenOut) {
  Camera camera = PinholeCamera(70, 1920, 1080);
  camera.intrinsics.distortion[0] = -0.2;
  const Vec2d ray{0.4, -0.2};
  Tracks tracks;
  tracks.tracklets = {{1, {At(1, ProjectNormalized(camera.intrinsics, ray))}}};
  const Segments s = MakeSegments({}, tracks, camera, 30);
  EXPECT_NEAR(s.segments[0].sightings[0].ray.x, 0.4, 1e-9);
  EXPECT_NEAR(s.segments[0].sightings[0].ray.y, -0.2, 1e-9);
}

TEST(Segments, ShapesAreTurnedIntoBoxes) {
  const Camera camera = PinholeCamera(50, 1920, 1080);
  Tracks tracks;
  tracks.tracklets = {{1, {At(1, {500, 500}), At(2, {501, 500}), At(3, {502, 500})}}};
  for (Detection& d : tracks.tracklets[0].detections) d.shape = Shape{6, 2.5, 30, 12};
  tracks.tracklets[0].detections[2].shape = Shape{9, 3.75, 30, 27};  // half as large again
  const Segments s = MakeSegments({}, tracks, camera, 30);
  EXPECT_TRUE(s.has_shapes);
  const auto& sightings = s.segments[0].sightings;
  EXPECT_NEAR(*sightings[0].log_size, std::log(13 / camera.intrinsics.fx), 1e-6);
  EXPECT_NEAR(*sightings[2].log_size - *sightings[0].log_size, std::log(1.5), 1e-9);
  EXPECT_FALSE(
      MakeSegments({.use_size = false}, tracks, camera, 30).segments[0].sightings[0].log_size);
}

// A shape along +30 degrees of the picture: moments of its axes, turned; a box has no diagonal.
TEST(Segments, FormsByHand) {
  const Camera camera = PinholeCamera(50, 1920, 1080);
  Tracks tracks;
  tracks.tracklets = {{1, {At(1, {960, 540})}}};
  const Vec2d box = *MakeSegments({}, tracks, camera, 30).segments[0].sightings[0].ellipticity;
  EXPECT_NEAR(box.x, (144.0 - 25) / (144 + 25), 1e-6);
  EXPECT_EQ(box.y, 0);
  tracks.tracklets[0].detections[0].shape = Shape{6, 2, 30, 12};
  const Vec2d shape = *MakeSegments({}, tracks, camera, 30).segments[0].sightings[0].ellipticity;
  EXPECT_NEAR(shape.x, 32.0 / 40 * 0.5, 1e-6);
  EXPECT_NEAR(shape.y, 32.0 / 40 * std::sqrt(0.75), 1e-6);
}

// Towards its edge a wide lens presses pictures together along the radius; out of boxes that is
// taken as out of shapes.
TEST(Segments, FormsAreThoseWithoutDistortion) {
  Camera camera = PinholeCamera(90, 1920, 1080);
  Tracks tracks;
  tracks.tracklets = {{1, {At(1, {1700, 540})}}};
  const auto form = [&] {
    return MakeSegments({}, tracks, camera, 30).segments[0].sightings[0].ellipticity->x;
  };
  const double without = form();
  camera.intrinsics.distortion = {-0.1, 0, 0, 0, 0};
  const double box = form();
  EXPECT_GT(box, without + 0.02);
  const Box& place = tracks.tracklets[0].detections[0].box;
  tracks.tracklets[0].detections[0].shape = Shape{place.width, place.height, 0, 12};
  EXPECT_NEAR(form(), box, 1e-9);
}

// A camera that is rolled by 20 degrees sees a shape turned by as much; in the reference axes it is
// what the camera saw that was not.
TEST(Segments, FormsTurnWithTheCamera) {
  Camera camera = PinholeCamera(50, 1920, 1080);
  constexpr double kTurn = 20;
  const double angle = kTurn * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  const Rotation3d rolled = Rotation3d::FromRows({c, s, 0}, {-s, c, 0}, {0, 0, 1});
  camera.cam_from_world_per_frame = {Rigid3d{}, Rigid3d{rolled, {}}};
  Tracks tracks;
  tracks.tracklets = {{1, {At(1, {959.5, 539.5}), At(2, {959.5, 539.5})}}};
  tracks.tracklets[0].detections[0].shape = Shape{6, 2, 30, 12};
  tracks.tracklets[0].detections[1].shape = Shape{6, 2, 30 - kTurn, 12};
  const Segments segments = MakeSegments({}, tracks, camera, 30);
  const auto& sightings = segments.segments[0].sightings;
  EXPECT_NEAR(sightings[0].ellipticity->x, sightings[1].ellipticity->x, 1e-4);
  EXPECT_NEAR(sightings[0].ellipticity->y, sightings[1].ellipticity->y, 1e-4);
  for (Detection& d : tracks.tracklets[0].detections) d.shape.reset();  // boxes do not turn along
  EXPECT_FALSE(MakeSegments({}, tracks, camera, 30).segments[0].sightings[0].ellipticity);
}

TEST(Segments, NoiseIsEstimated) {
  const FlockSpec flock;
  const Camera camera = WatchingCamera();
  const Trajectories truth = CirclingFlock(flock);
  for (double sd : {0.5, 2.0}) {
    const Segments s =
        MakeSegments({}, Observe(flock, {.pixel_sd = sd}, truth, camera), camera, flock.fps);
    EXPECT_NEAR(s.pixel_sd, sd, 0.15 * sd);
    EXPECT_EQ(s.cuts, 0);
  }
}

// Two animals whose identities are exchanged in the middle: both tracks are cut there, and nothing
// is lost.
TEST(Segments, IdentitySwitchesAreCut) {
  const FlockSpec flock{.count = 6};
  const Camera camera = WatchingCamera();
  Tracks tracks = Observe(flock, {}, CirclingFlock(flock), camera);
  constexpr std::size_t kSwitch = 70;
  for (std::size_t k = kSwitch; k < 150; ++k) {
    std::swap(tracks.tracklets[1].detections[k].box, tracks.tracklets[4].detections[k].box);
  }
  const Segments s = MakeSegments({}, tracks, camera, flock.fps);
  EXPECT_EQ(s.cuts, 2);
  ASSERT_EQ(s.segments.size(), 8u);
  for (const std::size_t cut : {std::size_t{1}, std::size_t{5}}) {
    EXPECT_EQ(s.segments[cut].id, s.segments[cut + 1].id);
    EXPECT_EQ(s.segments[cut].sightings.size(), kSwitch);
    EXPECT_EQ(s.segments[cut + 1].sightings.size(), 150 - kSwitch);
  }
  EXPECT_EQ(MakeSegments({.jump = 0}, tracks, camera, flock.fps).cuts, 0);
}

TEST(Segments, NothingIsNoFault) {
  const Segments s = MakeSegments({}, {}, WatchingCamera(), 30);
  EXPECT_TRUE(s.segments.empty());
  EXPECT_THROW(MakeSegments({}, {}, WatchingCamera(), 0), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
