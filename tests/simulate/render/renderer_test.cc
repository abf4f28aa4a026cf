// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "simulate/camera/projection.h"
#include "simulate/core/rng.h"
#include "simulate/core/triangle_mesh.h"

namespace flocklift {
namespace {

// No noise, blur, haze or clouds: what differs from the empty picture is the animal.
RenderSpec Clean(const std::string& background = "plain") {
  return {.background = background, .noise = 0, .blur = 0, .haze = 0, .cloud_speed_px = 0.5};
}

// The centroid of what the animal darkened, and by how much in all.
struct Darkening {
  double sum = 0, u = 0, v = 0, largest = 0;
  Darkening(const Image& without, const Image& with) {
    for (int row = 0; row < with.height; ++row) {
      for (int column = 0; column < with.width; ++column) {
        double dark = 0;
        for (int c = 0; c < 3; ++c) {
          dark += without.Row(row)[3 * column + c] - with.Row(row)[3 * column + c];
        }
        sum += dark;
        u += dark * column;
        v += dark * row;
        largest = std::max(largest, dark / 3);
      }
    }
    u /= sum;
    v /= sum;
  }
};

FlyingAnimal BirdAt(const Camera& camera, const Vec2d& pixel, double depth, double span_px,
                    const Vec3d& heading) {
  FlyingAnimal bird;
  bird.animal.id = 1;
  bird.animal.wingspan = span_px * depth / camera.intrinsics.fx;
  bird.animal.body_length = 0.5 * bird.animal.wingspan;
  const auto ray = RayThroughPixel(camera.intrinsics, pixel);
  bird.position = camera.CamFromWorld(1).Inverse() * (depth * Vec3d{ray->x, ray->y, 1});
  bird.velocity = 10.0 * Normalized(heading);
  bird.world_from_body = WorldFromLevelBody(heading);
  return bird;
}

// The requirement: within 0.05 px, for birds of 2 to 60 px, at any place in a pixel and pose. Of a
// silhouette below half a square pixel (a bird of 2 px seen end-on), whole grey levels keep less.
TEST(RendererTest, CentroidOfThePixelsIsTheProjectedPosition) {
  Camera camera = PinholeCamera(50, 160, 120);
  camera.cam_from_world = LookAt({0, -45, 1.7}, {0, 0, 12});
  Camera distorted = camera;
  distorted.intrinsics.distortion = {-0.25, 0.08, 0.001, -0.001};
  double worst = 0;
  for (const Camera& c : {camera, distorted}) {
    const FlockRenderer renderer(c, Clean(), 30, 1);
    const Image empty = renderer.Render(1, 0, {});
    for (const double span_px : {2.0, 3.0, 5.0, 10.0, 25.0, 60.0}) {
      for (std::uint64_t trial = 0; trial < 30; ++trial) {
        Rng rng(8, trial, static_cast<std::uint32_t>(span_px));
        const Vec2d pixel{80 + rng.Uniform(-20, 20), 60 + rng.Uniform(-15, 15)};
        const FlyingAnimal bird = BirdAt(c, pixel, rng.Uniform(15, 80), span_px,
                                         {rng.Normal(), rng.Normal(), 0.3 * rng.Normal()});
        const Image image = renderer.Render(1, rng.Uniform(0, 1), {&bird, 1});
        const Darkening dark(empty, image);
        const double error = std::hypot(dark.u - pixel.x, dark.v - pixel.y);
        const double area_px = dark.sum / (3 * 150.0);
        EXPECT_LE(error, 0.05 * std::max(1.0, 0.5 / area_px))
            << "span " << span_px << " px, trial " << trial << ", area " << area_px;
        if (area_px > 0.5) worst = std::max(worst, error);
      }
    }
  }
  RecordProperty("worst_px", std::to_string(worst));
}

TEST(RendererTest, MotionBlurIsCentredOnTheFrame) {
  Camera camera = PinholeCamera(50, 200, 120);
  RenderSpec spec = Clean();
  spec.blur = 0.5;
  const FlockRenderer blurred(camera, spec, 30, 1), sharp(camera, Clean(), 30, 1);
  const Image empty = sharp.Render(1, 0, {});
  const Vec2d pixel{101.3, 58.8};
  FlyingAnimal bird = BirdAt(camera, pixel, 10, 12, {1, 0, 0});
  bird.velocity = {20, 0, 0};
  const double way_px = 20 * 0.5 / 30 * camera.intrinsics.fx / 10;
  const Darkening with_blur(empty, blurred.Render(1, 0.3, {&bird, 1}));
  const Darkening without(empty, sharp.Render(1, 0.3, {&bird, 1}));
  EXPECT_NEAR(with_blur.u, pixel.x, 0.05);
  EXPECT_NEAR(with_blur.v, pixel.y, 0.05);
  EXPECT_NEAR(with_blur.sum, without.sum, 0.06 * without.sum);
  // The darkened columns grow by the way of the bird.
  const auto columns = [&](const Image& image) {
    int n = 0;
    for (int u = 0; u < image.width; ++u) {
      for (int v = 0; v < image.height; ++v) {
        if (image.Row(v)[3 * u] + 3 < empty.Row(v)[3 * u]) {
          ++n;
          break;
        }
      }
    }
    return n;
  };
  EXPECT_NEAR(
      columns(blurred.Render(1, 0.3, {&bird, 1})) - columns(sharp.Render(1, 0.3, {&bird, 1})),
      way_px, 3);
}

TEST(RendererTest, ContrastFallsWithDepthBehindHaze) {
  Camera camera = PinholeCamera(50, 200, 120);
  RenderSpec spec = Clean();
  spec.haze = 40;
  const FlockRenderer hazy(camera, spec, 30, 1), clear(camera, Clean(), 30, 1);
  const Image empty = clear.Render(1, 0, {});
  for (const double depth : {10.0, 40.0, 100.0}) {
    FlyingAnimal bird = BirdAt(camera, {100, 60}, depth, 60, {1, 0, 0});
    const double ratio = Darkening(empty, hazy.Render(1, 0, {&bird, 1})).largest /
                         Darkening(empty, clear.Render(1, 0, {&bird, 1})).largest;
    EXPECT_NEAR(ratio, std::exp(-depth / 40), 0.02) << depth;
  }
}

TEST(RendererTest, NearerAnimalsAreDrawnOverFartherOnes) {
  Camera camera = PinholeCamera(50, 200, 120);
  RenderSpec spec = Clean();
  spec.haze = 30;  // so that the two have different tones
  const FlockRenderer renderer(camera, spec, 30, 1);
  FlyingAnimal near = BirdAt(camera, {100, 60}, 10, 60, {1, 0, 0});
  FlyingAnimal far = BirdAt(camera, {100, 60}, 90, 60, {1, 0, 0});
  far.animal.id = 2;
  const std::vector<FlyingAnimal> a{near, far}, b{far, near};
  const Image picture = renderer.Render(1, 0, a);
  EXPECT_EQ(picture.bgr, renderer.Render(1, 0, b).bgr);
  const Image alone = renderer.Render(1, 0, {&near, 1});
  // The far one adds little where the near one is: haze lets 28 % of the near one's ground through.
  EXPECT_NEAR(picture.Row(60)[300], alone.Row(60)[300], 5);
}

TEST(RendererTest, NoiseHasItsStandardDeviationAndIsNew) {
  Camera camera = PinholeCamera(50, 320, 240);
  RenderSpec spec = Clean();
  spec.noise = 4;
  const FlockRenderer noisy(camera, spec, 30, 5), clean(camera, Clean(), 30, 5);
  const Image a = noisy.Render(1, 0, {}), b = noisy.Render(2, 0, {}), flat = clean.Render(1, 0, {});
  double sum = 0, squares = 0, across = 0, neighbours = 0;
  const std::size_t n = a.bgr.size();
  for (std::size_t k = 0; k < n; ++k) {
    const double x = a.bgr[k] - flat.bgr[k], y = b.bgr[k] - flat.bgr[k];
    sum += x;
    squares += x * x;
    across += x * y;
    if (k + 3 < n) neighbours += x * (a.bgr[k + 3] - flat.bgr[k + 3]);
  }
  const double variance = squares / static_cast<double>(n);
  EXPECT_NEAR(sum / static_cast<double>(n), 0, 0.05);
  EXPECT_NEAR(std::sqrt(variance), 4, 0.1);
  EXPECT_NEAR(across / static_cast<double>(n) / variance, 0, 0.03);
  EXPECT_NEAR(neighbours / static_cast<double>(n) / variance, 0, 0.03);
}

TEST(RendererTest, SameArgumentsSamePictureOtherSeedOther) {
  Camera camera = PinholeCamera(50, 320, 240);
  const RenderSpec spec;
  FlyingAnimal bird = BirdAt(camera, {150, 100}, 20, 40, {1, 0, 1});
  const FlockRenderer a(camera, spec, 30, 9), b(camera, spec, 30, 9), c(camera, spec, 30, 10);
  const Image picture = a.Render(12, 0.4, {&bird, 1});
  EXPECT_EQ(picture.bgr, a.Render(12, 0.4, {&bird, 1}).bgr);
  EXPECT_EQ(picture.bgr, b.Render(12, 0.4, {&bird, 1}).bgr);
  EXPECT_NE(picture.bgr, c.Render(12, 0.4, {&bird, 1}).bgr);
  EXPECT_NE(picture.bgr, a.Render(13, 0.4, {&bird, 1}).bgr);
}

TEST(RendererTest, CloudsDriftBySubPixelsAndForEver) {
  Camera camera = PinholeCamera(50, 320, 180);
  RenderSpec spec = Clean("clouds");
  spec.cloud_speed_px = 0.25;
  const FlockRenderer renderer(camera, spec, 30, 3);
  const Image first = renderer.Render(1, 0, {}), fifth = renderer.Render(5, 0, {});
  int structure = 0;
  for (int v = 0; v < first.height; ++v) {
    for (int u = 0; u + 1 < first.width; ++u) {
      EXPECT_NEAR(fifth.Row(v)[3 * (u + 1)], first.Row(v)[3 * u], 1);  // one pixel to the right
      structure += std::abs(first.Row(v)[3 * u] - first.Row(v)[3 * (u + 1)]);
    }
  }
  EXPECT_GT(structure, first.width * first.height / 20);
  EXPECT_NE(renderer.Render(2, 0, {}).bgr, first.bgr);  // a quarter of a pixel shows
  const Image late = renderer.Render(1'000'000, 0, {});
  EXPECT_NE(late.bgr, first.bgr);
}

TEST(RendererTest, SkyPalesTowardsTheHorizon) {
  Camera camera = PinholeCamera(50, 64, 64);
  const FlockRenderer renderer(camera, Clean("sky"), 30, 3);
  const Image sky = renderer.Render(1, 0, {});
  EXPECT_GT(sky.Row(63)[2], sky.Row(0)[2] + 50);  // red
  EXPECT_GT(sky.Row(0)[0], sky.Row(0)[2] + 50);   // blue above red at the zenith
}

TEST(RendererTest, BirdsAcrossTheBorderAreCutOff) {
  Camera camera = PinholeCamera(50, 64, 48);
  const FlockRenderer renderer(camera, Clean(), 30, 1);
  const Image empty = renderer.Render(1, 0, {});
  for (const Vec2d& pixel : {Vec2d{0, 0}, Vec2d{63, 20}, Vec2d{30, 47.4}, Vec2d{-2, 50}}) {
    FlyingAnimal bird = BirdAt(camera, pixel, 10, 20, {0.3, 0.4, 1});
    EXPECT_GT(Darkening(empty, renderer.Render(1, 0, {&bird, 1})).sum, 0);
  }
  FlyingAnimal close = BirdAt(camera, {30, 20}, 1.2, 100, {1, 0, 0});
  EXPECT_GT(Darkening(empty, renderer.Render(1, 0, {&close, 1})).sum, 0);
}

// Below kSpeckPx the area alone is drawn: the darkness of a bird must not jump there.
TEST(RendererTest, DarknessGoesOnAcrossTheSizeOfASpeck) {
  const Camera camera = PinholeCamera(50, 200, 160);
  RenderSpec blurred = Clean();
  blurred.blur = 0.5;
  const FlockRenderer renderer(camera, blurred, 30, 1);
  const Image empty = renderer.Render(1, 0, {});
  double worst = 0;
  for (std::uint64_t trial = 0; trial < 12; ++trial) {
    double sum[2] = {0, 0};
    for (const int side : {0, 1}) {
      // Many birds in the same pose, each at its own place in a pixel, so that whole grey levels
      // average out; as far as the scale, the two pictures are the same.
      const double span_px = kSpeckPx * (side == 0 ? 1 - 1e-6 : 1 + 1e-6);
      Rng pose(5, trial);
      const Vec3d heading{pose.Normal(), pose.Normal(), 0.5 * pose.Normal()};
      const double speed = trial % 2 == 0 ? 0 : 3;
      std::vector<FlyingAnimal> birds;
      for (int k = 0; k < 88; ++k) {
        Rng place(6, static_cast<std::uint64_t>(k));
        const Vec2d pixel{20 + 15 * (k % 11) + place.Uniform(),
                          20 + 15 * (k / 11) + place.Uniform()};
        birds.push_back(BirdAt(camera, pixel, 20, span_px, heading));
        birds.back().velocity = speed * Normalized(heading);
      }
      const Darkening dark(empty, renderer.Render(1, 0.3, birds));
      sum[side] = dark.sum;
    }
    EXPECT_NEAR(sum[0] / sum[1], 1, 0.05) << trial;
    worst = std::max(worst, std::abs(sum[0] / sum[1] - 1));
  }
  RecordProperty("worst", std::to_string(worst));
}

// A swarm far away must darken the sky by the area of its animals, however small each is.
TEST(RendererTest, ManyTinyAnimalsKeepTheirTotalDarkness) {
  const Camera camera = PinholeCamera(50, 200, 160);
  RenderSpec spec = Clean();
  spec.noise = 3;  // the same in both pictures: what is less than a grey level is not rounded away
  const FlockRenderer renderer(camera, spec, 30, 1);
  const Image empty = renderer.Render(1, 0, {});
  double per_area = 0;
  for (const double span_px : {1.2, 0.3, 0.08}) {
    std::vector<FlyingAnimal> swarm;
    const int count = static_cast<int>(1500 / (span_px * span_px));
    for (int k = 0; k < count; ++k) {
      Rng rng(9, static_cast<std::uint64_t>(k));
      swarm.push_back(
          BirdAt(camera, {rng.Uniform(10, 190), rng.Uniform(10, 150)}, 20, span_px, {1, 0.2, 0.4}));
    }
    const double darkness =
        Darkening(empty, renderer.Render(1, 0, swarm)).sum / (count * span_px * span_px);
    if (per_area == 0) per_area = darkness;
    EXPECT_NEAR(darkness / per_area, 1, 0.02) << span_px;
  }
}

// A wall 20 m away, over the left half of the image.
struct Wall {
  TriangleMesh mesh{{{-30, -30, 20}, {0, -30, 20}, {0, 30, 20}, {-30, 30, 20}},
                    {{0, 1, 2}, {0, 2, 3}}};
  std::vector<Color> tones{{120, 130, 140}};
  Surface surface{.vertices = mesh.vertices,
                  .triangles = mesh.triangles,
                  .tones = tones,
                  .normals = {},
                  .velocities = {}};
};

TEST(RendererTest, AnObstacleHidesAnimalsBehindItAlone) {
  const Camera camera = PinholeCamera(50, 200, 120);
  const FlockRenderer renderer(camera, Clean(), 30, 1);
  const Wall wall;
  const Setting setting{.surfaces = {&wall.surface, 1}, .strokes = {}, .balls = {}};
  const Image empty = renderer.Render(1, 0, {}), walled = renderer.Render(1, 0, {}, setting);
  EXPECT_NE(walled.Row(60)[3 * 50], empty.Row(60)[3 * 50]);
  EXPECT_EQ(walled.Row(60)[3 * 150], empty.Row(60)[3 * 150]);
  for (const double span_px : {1.0, 30.0}) {  // a speck, and a silhouette
    for (const double depth : {10.0, 40.0}) {
      const FlyingAnimal left = BirdAt(camera, {50, 60}, depth, span_px, {1, 0, 0.2});
      const FlyingAnimal right = BirdAt(camera, {150, 60}, depth, span_px, {1, 0, 0.2});
      EXPECT_EQ(renderer.Render(1, 0, {&left, 1}, setting).bgr == walled.bgr, depth > 20)
          << span_px << " " << depth;
      EXPECT_NE(renderer.Render(1, 0, {&right, 1}, setting).bgr, walled.bgr);
    }
  }
  // Across the edge, half of the bird is left.
  const FlyingAnimal across = BirdAt(camera, {99.5, 60}, 40, 40, {0, 0, 1});
  const double whole = Darkening(empty, renderer.Render(1, 0, {&across, 1})).sum;
  const double half = Darkening(walled, renderer.Render(1, 0, {&across, 1}, setting)).sum;
  EXPECT_NEAR(half / whole, 0.5, 0.03);
}

TEST(RendererTest, OneFrameLeavesNothingForTheNext) {
  const Camera camera = PinholeCamera(50, 200, 120);
  const FlockRenderer used(camera, {}, 30, 1), fresh(camera, {}, 30, 1);
  const Wall wall;
  const Stroke line{.points = {{-5, 0, 15}, {5, 1, 25}}, .color = {0, 0, 255}};
  const TintedBall ball{.center = {3, 0, 18}, .radius = 2, .color = {0, 200, 0}};
  const Setting setting{.surfaces = {&wall.surface, 1}, .strokes = {&line, 1}, .balls = {&ball, 1}};
  const FlyingAnimal bird = BirdAt(camera, {90, 60}, 20, 30, {1, 0, 0});
  const Image first = used.Render(1, 0, {&bird, 1}, setting);
  EXPECT_EQ(used.Render(2, 0.1, {&bird, 1}).bgr, fresh.Render(2, 0.1, {&bird, 1}).bgr);
  EXPECT_EQ(used.Render(1, 0, {&bird, 1}, setting).bgr, first.bgr);
}

TEST(RendererTest, LinesAndBallsAreHiddenByObstacles) {
  const Camera camera = PinholeCamera(50, 200, 120);
  const FlockRenderer renderer(camera, Clean(), 30, 1);
  const Wall wall;
  const Stroke line{.points = {{-10, 0, 30}, {10, 0, 30}}, .color = {0, 0, 255}, .width_px = 3};
  const TintedBall ball{.center = {0, 3, 40}, .radius = 3, .color = {0, 200, 0}, .opacity = 0.5};
  const Setting bare{.surfaces = {&wall.surface, 1}, .strokes = {}, .balls = {}};
  const Setting marked{.surfaces = {&wall.surface, 1}, .strokes = {&line, 1}, .balls = {&ball, 1}};
  const Image without = renderer.Render(1, 0, {}, bare), with = renderer.Render(1, 0, {}, marked);
  int changed[2] = {0, 0};
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 200; ++u) {
      const bool differs = with.Row(v)[3 * u] != without.Row(v)[3 * u];
      changed[u < 99 ? 0 : 1] += differs ? 1 : 0;
    }
  }
  EXPECT_EQ(changed[0], 0);
  EXPECT_GT(changed[1], 200);
}

TEST(RendererTest, RefusesWhatIsOutOfRange) {
  const Camera camera = PinholeCamera(50, 64, 48);
  const auto with = [&](auto change) {
    RenderSpec spec;
    change(&spec);
    FlockRenderer(camera, spec, 30, 1);
  };
  EXPECT_THROW(with([](RenderSpec* s) { s->background = "sea"; }), std::invalid_argument);
  EXPECT_THROW(with([](RenderSpec* s) { s->noise = -1; }), std::invalid_argument);
  EXPECT_THROW(with([](RenderSpec* s) { s->blur = 1.1; }), std::invalid_argument);
  EXPECT_THROW(with([](RenderSpec* s) { s->haze = -1; }), std::invalid_argument);
  EXPECT_THROW(with([](RenderSpec* s) { s->cloud_speed_px = std::nan(""); }),
               std::invalid_argument);
  EXPECT_THROW(FlockRenderer(Camera{}, {}, 30, 1), std::invalid_argument);
  EXPECT_THROW(FlockRenderer(camera, {}, 0, 1), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
