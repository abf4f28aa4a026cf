// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "simulate/camera/projection.h"
#include "simulate/core/rng.h"
#include "simulate/core/triangle_mesh.h"

namespace flocklift {
namespace {

const std::vector<Color> kGrey{{128, 128, 128}};

Surface ViewOf(const TriangleMesh& mesh) {
  return {.vertices = mesh.vertices,
          .triangles = mesh.triangles,
          .tones = kGrey,
          .normals = {},
          .velocities = {}};
}

TriangleMesh OneTriangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return {{a, b, c}, {{0, 1, 2}}};
}

// Where the ray through an image point meets a triangle in the camera frame, by Moeller and
// Trumbore; depth 0 where it does not. `margin` is how far inside, in barycentric coordinates.
struct Hit {
  double depth, margin;
};
Hit Meet(const Vec3d& direction, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d ab = b - a, ac = c - a, p = Cross(direction, ac), s = -a, q = Cross(s, ab);
  const double det = Dot(ab, p);
  const double wb = Dot(s, p) / det, wc = Dot(direction, q) / det, t = Dot(ac, q) / det;
  return {t > 0 ? t * direction.z : 0, std::min({wb, wc, 1 - wb - wc})};
}

// Every sample against its ray: the lens, the near plane, depth and gaps at once.
void ExpectAsRaysSee(const Camera& camera, std::uint64_t seed, int* checked, int* hits) {
  Rng rng(11, seed);
  TriangleMesh mesh;
  for (int k = 0; k < 3; ++k) {
    mesh.vertices.push_back({rng.Uniform(-6, 6), rng.Uniform(-6, 6), rng.Uniform(-4, 10)});
  }
  mesh.triangles.push_back({0, 1, 2});
  DepthBuffer buffer(camera.width, camera.height);
  SurfacePainter(camera).Draw(ViewOf(mesh), {}, 0, &buffer);
  for (int v = 0; v < camera.height; v += 2) {
    for (int u = 0; u < camera.width; u += 2) {
      const Vec2d place = DepthBuffer::kPlace[1];
      const auto meet = [&](double du, double dv) {
        const auto ray = RayThroughPixel(camera.intrinsics, {u + place.x + du, v + place.y + dv});
        return Meet({ray->x, ray->y, 1}, mesh.vertices[0], mesh.vertices[1], mesh.vertices[2]);
      };
      const Hit hit = meet(0, 0);
      if (std::abs(hit.margin) < 0.02 || (hit.depth > 0 && hit.depth < 0.1)) continue;
      ++*checked;
      if (hit.margin < 0 || hit.depth == 0) {
        EXPECT_EQ(buffer.Nearness(u, v, 1), 0) << seed << " at " << u << " " << v;
        continue;
      }
      ++*hits;
      // What is drawn straight may be a little off: 0.3 px.
      double low = 1e9, high = 0;
      for (const double du : {-0.3, 0.0, 0.3}) {
        for (const double dv : {-0.3, 0.0, 0.3}) {
          const double nearness = 1 / meet(du, dv).depth;
          low = std::min(low, nearness);
          high = std::max(high, nearness);
        }
      }
      EXPECT_GE(buffer.Nearness(u, v, 1), low - 1e-5) << seed << " " << u << " " << v;
      EXPECT_LE(buffer.Nearness(u, v, 1), high + 1e-5) << seed << " " << u << " " << v;
    }
  }
}

TEST(SurfaceTest, SamplesSeeWhatTheirRaysMeet) {
  const Camera camera = PinholeCamera(60, 96, 64);
  Camera barrel = camera, pincushion = camera;
  barrel.intrinsics.distortion = {-0.25, 0.06, 0.002, -0.001};
  pincushion.intrinsics.distortion = {0.2, 0.05, -0.001, 0.002};
  int checked = 0, hits = 0;
  for (std::uint64_t seed = 0; seed < 25; ++seed) {
    for (const Camera& c : {camera, barrel, pincushion}) ExpectAsRaysSee(c, seed, &checked, &hits);
  }
  EXPECT_GT(checked, 50'000);
  EXPECT_GT(hits, 3000);
}

TEST(SurfaceTest, AFoldOfTheLensBringsNothingIntoTheImage) {
  Camera camera = PinholeCamera(60, 96, 64);
  camera.intrinsics.distortion = {-0.3, 0, 0, 0};  // folds at r = 1.05
  // Far outside the view; without care it would be projected into its middle.
  const TriangleMesh mesh = OneTriangle({8, -1, 5}, {9, -1, 5}, {8.5, 1, 5});
  const Vec2d folded = Project(camera.intrinsics, mesh.vertices[0]);
  ASSERT_TRUE(camera.Sees(folded) || folded.x < 0);
  DepthBuffer buffer(camera.width, camera.height);
  SurfacePainter(camera).Draw(ViewOf(mesh), {}, 0, &buffer);
  EXPECT_TRUE(buffer.empty());
}

TEST(SurfaceTest, TheGroundReachesFromTheFeetToTheHorizon) {
  Camera camera = PinholeCamera(60, 80, 61);
  camera.cam_from_world = LookAt({0, 0, 2}, {0, 10, 2});  // level: the horizon is row 30
  const double far = 1e5;
  const TriangleMesh ground = OneTriangle({-far, -far, 0}, {far, -far, 0}, {0, 2 * far, 0});
  DepthBuffer buffer(camera.width, camera.height);
  SurfacePainter(camera).Draw(ViewOf(ground), *camera.cam_from_world, 0, &buffer);
  for (const int u : {0, 40, 79}) {
    for (const int v : {0, 15, 29}) EXPECT_EQ(buffer.Covered(u, v), 0) << u << " " << v;
    for (const int v : {31, 45, 60}) EXPECT_EQ(buffer.Covered(u, v), 4) << u << " " << v;
  }
  EXPECT_NEAR(1 / buffer.Nearness(40, 60, 0),
              2 * camera.intrinsics.fy / (60 + DepthBuffer::kPlace[0].y - 30), 1e-3);
}

TEST(SurfaceTest, ShadeByHand) {
  Camera camera = PinholeCamera(60, 80, 60);
  camera.cam_from_world = LookAt({0, 0, 2}, {0, 10, 2});
  const SurfacePainter painter(camera);
  const double sun_up = 0.74 / std::sqrt(0.36 + 0.09 + 0.74 * 0.74);
  EXPECT_NEAR(painter.Shade({0, 0, 1}), 0.35 + 0.25 + 0.5 * sun_up, 1e-12);
  EXPECT_NEAR(painter.Shade({0, 0, -1}), 0.35, 1e-12);
  // From below and from above, whichever way the triangle runs.
  for (const bool is_reversed : {false, true}) {
    TriangleMesh wall = OneTriangle({-5, 20, -5}, {5, 20, -5}, {0, 20, 9});
    if (is_reversed) std::swap(wall.triangles[0][0], wall.triangles[0][1]);
    DepthBuffer buffer(camera.width, camera.height);
    painter.Draw(ViewOf(wall), *camera.cam_from_world, 0, &buffer);
    EXPECT_NEAR(buffer.Tone(40, 30, 0)[0], 128 * painter.Shade({0, -1, 0}), 0.51);
  }
}

TEST(SurfaceTest, EachSampleSeesItsMomentOfAMovingSurface) {
  const Camera camera = PinholeCamera(60, 80, 60);
  // One pixel a millimetre at this depth; 8 px to the right while the shutter is open.
  const double depth = camera.intrinsics.fx / 1000;
  const auto at = [&](double u, double v) {
    return Vec3d{(u - camera.intrinsics.cx) / 1000, (v - camera.intrinsics.cy) / 1000, depth};
  };
  TriangleMesh mesh{{at(20.1, -50), at(60.1, -50), at(60.1, 110), at(20.1, 110)},
                    {{0, 1, 2}, {0, 2, 3}}};
  Surface surface = ViewOf(mesh);
  const std::vector<Vec3d> velocities(4, Vec3d{0.8, 0, 0});
  surface.velocities = velocities;
  DepthBuffer buffer(camera.width, camera.height), still(camera.width, camera.height);
  SurfacePainter(camera).Draw(surface, {}, 0.01, &buffer);
  SurfacePainter(camera).Draw(surface, {}, 0, &still);
  double sum = 0, centroid = 0, sum_still = 0, centroid_still = 0;
  int partly = 0;
  for (int u = 0; u < camera.width; ++u) {
    const int covered = buffer.Covered(u, 30), before = still.Covered(u, 30);
    sum += covered;
    centroid += covered * u;
    sum_still += before;
    centroid_still += before * u;
    partly += covered > 0 && covered < 4 ? 1 : 0;
  }
  EXPECT_NEAR(sum, sum_still, 4);
  EXPECT_NEAR(centroid / sum, centroid_still / sum_still, 0.3);  // centred on the frame's time
  EXPECT_GE(partly, 2 * 5);                                      // a ramp at both ends
}

TEST(SurfaceTest, FacesOfTetrahedraPointOutwards) {
  const std::vector<Vec3d> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                                    {5, 5, 5}, {7, 5, 5}, {5, 8, 6}, {5, 5, 9}};
  const auto faces = TetrahedraFaces(2);
  ASSERT_EQ(faces.size(), 8U);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::size_t first = 4 * (f / 4);
    Vec3d middle;
    for (std::size_t k = 0; k < 4; ++k) middle += 0.25 * vertices[first + k];
    const Vec3d &a = vertices[faces[f][0]], &b = vertices[faces[f][1]], &c = vertices[faces[f][2]];
    EXPECT_GT(Dot(Cross(b - a, c - a), a - middle), 0) << f;
  }
}

TEST(SurfaceTest, RefusesListsOfOtherLengths) {
  const Camera camera = PinholeCamera(60, 80, 60);
  const SurfacePainter painter(camera);
  DepthBuffer buffer(camera.width, camera.height);
  const TriangleMesh mesh = OneTriangle({0, 0, 5}, {1, 0, 5}, {0, 1, 5});
  const std::vector<Vec3d> two(2);
  const std::vector<Color> three(3);
  Surface surface = ViewOf(mesh);
  surface.normals = two;
  EXPECT_THROW(painter.Draw(surface, {}, 0, &buffer), std::invalid_argument);
  surface = ViewOf(mesh);
  surface.velocities = two;
  EXPECT_THROW(painter.Draw(surface, {}, 0, &buffer), std::invalid_argument);
  surface = ViewOf(mesh);
  surface.tones = three;
  EXPECT_THROW(painter.Draw(surface, {}, 0, &buffer), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
