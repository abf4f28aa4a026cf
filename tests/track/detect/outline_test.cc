// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/outline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "simulate/camera/camera.h"
#include "simulate/camera/projection.h"
#include "simulate/core/rng.h"
#include "simulate/render/renderer.h"
#include "track/detect/detector.h"

namespace flocklift {
namespace {

// The integral of the normal density over the pixel about x, averaged over a bar from 0 to `width`:
// what is seen of straight edges that lens and shutter spread by `blur` (sd) [px].
double SpreadBar(double x, double width, double blur) {
  constexpr int kParts = 200;
  double sum = 0;
  for (int k = 0; k < kParts; ++k) {
    const double at = x - 0.5 + (k + 0.5) / kParts;
    const double root = blur * std::sqrt(2.0);
    sum += 0.5 * (std::erf(at / root) - std::erf((at - width) / root));
  }
  return sum / kParts;
}

// A share q of the height lies z sds outside a straight edge, Phi(-z) = q: 0.524 for 0.3. A pixel
// adds 1/12 to the spread's variance. Between pixels the profile is taken for straight, which it is
// not: up to 0.2 px an end.
TEST(OutlineTest, StraightEdgesComeOutWiderByTheirSpread) {
  constexpr double kSds = 0.5244;
  for (const double blur : {0.4, 0.7}) {
    for (const double width : {6.0, 7.3, 12.6}) {
      for (const double offset : {0.0, 0.25, 0.5, 0.75}) {
        std::vector<float> profile;
        for (int k = 0; k < 40; ++k) {
          const double seen = SpreadBar(k - 12 - offset, width, blur);
          if (seen > 0.01) profile.push_back(static_cast<float>(90 * seen));
        }
        const double spread = std::sqrt(blur * blur + 1.0 / 12);
        EXPECT_NEAR(internal::OutlineOf(profile).length(), width + 2 * kSds * spread, 0.35)
            << blur << " " << width << " " << offset;
      }
    }
  }
}

TEST(OutlineTest, FaintEndsCountWhereTheirSurroundingsAreFaint) {
  // A wing of half the body's contrast: its end is judged by the wing.
  const std::vector<float> profile{50, 50, 50, 50, 100, 100, 100};
  EXPECT_NEAR(internal::OutlineOf(profile).first, -0.7, 1e-6);
  EXPECT_NEAR(internal::OutlineOf(profile).last, 6.7, 1e-6);
  // A haze about it is none of it.
  const std::vector<float> haze{5, 5, 100, 100, 100, 5};
  EXPECT_NEAR(internal::OutlineOf(haze).first, 2 - 70.0 / 95, 1e-5);
  EXPECT_NEAR(internal::OutlineOf(haze).last, 4 + 70.0 / 95, 1e-5);
}

TEST(OutlineTest, OnePixelIsAboutAPixel) {
  const std::vector<float> one{80};
  EXPECT_NEAR(internal::OutlineOf(one).length(), 1.4, 1e-6);
}

struct Sizes {
  double box = 0, whole_box = 0, shape = 0;  // mean log of (found over drawn)
};

// Birds of this span in the picture [px], flying and beating in all directions.
Sizes FoundOverDrawn(double span_px, std::uint64_t seed) {
  Camera camera = PinholeCamera(40, 640, 480);
  camera.cam_from_world = LookAt({0, 0, 0}, {0, 50, 0});
  Rng rng(seed);
  std::vector<FlyingAnimal> birds;
  const double depth = 50, focal = camera.intrinsics.fx;
  for (int k = 0; k < 48; ++k) {
    FlyingAnimal bird;
    bird.animal.id = k + 1;
    bird.animal.wingspan = span_px * depth / focal;
    bird.animal.body_length = 0.5 * bird.animal.wingspan;
    bird.animal.wingbeat_phase = rng.Uniform(0, 6.28);
    const double u = 40 + 80 * (k % 8) + rng.Uniform(-1, 1);
    const double v = 40 + 80 * (k / 8) + rng.Uniform(-1, 1);
    const auto ray = RayThroughPixel(camera.intrinsics, {u, v});
    bird.position = camera.CamFromWorld(1).Inverse() * (depth * Vec3d{ray->x, ray->y, 1});
    const Vec3d heading = Normalized(Vec3d{rng.Normal(), rng.Normal(), 0.3 * rng.Normal()});
    bird.velocity = 10.0 * heading;
    bird.world_from_body = WorldFromLevelBody(heading);
    birds.push_back(bird);
  }
  const RenderSpec spec{.background = "plain", .noise = 2, .blur = 0.2, .haze = 300};
  const Image picture = FlockRenderer(camera, spec, 30, seed).Render(1, 0, birds);
  GrayImage gray(picture.width, picture.height);
  for (int v = 0; v < gray.height; ++v) {
    for (int u = 0; u < gray.width; ++u) gray.Row(v)[u] = picture.Row(v)[3 * u + 1];
  }
  Detector detector({.polarity = "dark"});
  const std::vector<GrayImage> first{gray};
  ThreadPool pool(1);
  detector.Learn(first, &pool);
  const BlobFrame found = detector.Detect(1, gray);
  Sizes sizes;
  int count = 0;
  for (const FlyingAnimal& bird : birds) {
    const auto body = ProjectBody(bird, 0, camera, camera.CamFromWorld(1));
    for (const Blob& blob : found.blobs) {
      const double dx = blob.center.x - body->center.x, dy = blob.center.y - body->center.y;
      if (std::hypot(dx, dy) > 2) continue;
      const auto pixels = std::span(found.pixels).subspan(blob.first_pixel, blob.pixel_count);
      double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
      for (const BlobPixel& p : pixels) {
        left = std::min<double>(left, p.x), right = std::max<double>(right, p.x);
        top = std::min<double>(top, p.y), bottom = std::max<double>(bottom, p.y);
      }
      const Box drawn = BoundsOf(body->silhouette);
      const double diagonal = std::hypot(drawn.width, drawn.height);
      sizes.box += std::log(std::hypot(blob.box.width, blob.box.height) / diagonal);
      sizes.whole_box += std::log(std::hypot(right - left + 1, bottom - top + 1) / diagonal);
      const Shape shape = ShapeOf(blob.moments, 0), own = ShapeOf(body->moments);
      sizes.shape +=
          std::log(std::hypot(shape.major, shape.minor) / std::hypot(own.major, own.minor));
      ++count;
    }
  }
  EXPECT_GT(count, 40) << span_px;
  return {sizes.box / count, sizes.whole_box / count, sizes.shape / count};
}

TEST(OutlineTest, BirdsComeOutAsLargeAsTheyAre) {
  for (const double span_px : {9.0, 14.0, 22.0, 40.0}) {
    const Sizes found = FoundOverDrawn(span_px, 3);
    EXPECT_NEAR(found.box, 0, 0.045) << span_px;
    EXPECT_NEAR(found.shape, 0, 0.045) << span_px;
    EXPECT_GT(found.whole_box, 0.05) << span_px;
  }
}

}  // namespace
}  // namespace flocklift
