// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/scenery.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/render/soft_normals.h"

namespace flocklift {
namespace {

constexpr double kMostLines = 60;  // of the ground, along its longer side

const std::vector<Color> kObstacleTones{kObstacleColor};

}  // namespace

MovingSurface MovingTetrahedra(std::size_t count, Color tone, decltype(MovingSurface::at) at) {
  return {.triangles = TetrahedraFaces(count),
          .tones = {tone},
          .is_closed = false,
          .at = std::move(at)};
}

void Scenery::AddObstacle(TriangleMesh mesh) {
  std::vector<Vec3d> normals = SoftNormals(mesh);
  solids_.push_back({std::move(mesh), std::move(normals)});
}

void Scenery::AddGoal(std::function<Vec3d(double time)> center_at, double radius) {
  Check(radius > 0, "a goal that is drawn needs a radius");
  goals_.push_back({std::move(center_at), radius});
}

void Scenery::AddPath(std::vector<Vec3d> points) {
  strokes_.push_back(
      {.points = std::move(points), .color = kPathColor, .width_px = 1.5, .opacity = 0.8});
}

void Scenery::AddGround(const Region& region) {
  const double side = std::max(region.high.x - region.low.x, region.high.y - region.low.y);
  Check(side > 0, "the ground has no extent");
  const double spacing = std::pow(10, std::ceil(std::log10(side / kMostLines)));
  for (Stroke& line : GroundGrid(region, spacing, kGroundColor, 0.5)) {
    strokes_.push_back(std::move(line));
  }
}

void Scenery::AddSurface(MovingSurface surface) { moving_.push_back(std::move(surface)); }

void Scenery::WithSurfaces(int frame,
                           const std::function<void(std::span<const Surface>)>& use) const {
  std::vector<Surface> surfaces;
  for (const Solid& solid : solids_) {
    surfaces.push_back({.vertices = solid.mesh.vertices,
                        .triangles = solid.mesh.triangles,
                        .tones = kObstacleTones,
                        .normals = solid.normals,
                        .velocities = {}});
  }
  std::vector<std::vector<Vec3d>> vertices(moving_.size()), velocities(moving_.size());
  for (std::size_t k = 0; k < moving_.size(); ++k) {
    moving_[k].at(frame, &vertices[k], &velocities[k]);
    surfaces.push_back({.vertices = vertices[k],
                        .triangles = moving_[k].triangles,
                        .tones = moving_[k].tones,
                        .normals = {},
                        .velocities = velocities[k],
                        .is_closed = moving_[k].is_closed});
  }
  use(surfaces);
}

void Scenery::With(int frame, double time, const std::function<void(const Setting&)>& use) const {
  std::vector<Stroke> strokes = strokes_;
  std::vector<TintedBall> balls;
  for (const Goal& goal : goals_) {
    const Vec3d center = goal.center_at(time);
    balls.push_back({.center = center, .radius = goal.radius, .color = kGoalColor, .opacity = 0.2});
    strokes.push_back(Ring(center, goal.radius, {0, 0, 1}, kGoalColor, 1.5, 0.8));
  }
  WithSurfaces(frame, [&](std::span<const Surface> surfaces) {
    use({.surfaces = surfaces, .strokes = strokes, .balls = balls});
  });
}

}  // namespace flocklift
