// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/load_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "simulate/core/check.h"
#include "simulate/fields/surface_fault.h"
#include "simulate/shapes/mesh_io.h"
#include "simulate/shapes/solid_meshes.h"

namespace flocklift {
namespace {

constexpr int kPoses = 24;      // of an animation that a file holds, a period
constexpr int kBallRounds = 3;  // of cutting an octahedron's triangles in four

TriangleMesh Placed(TriangleMesh mesh, const Placement& placement) {
  const double yaw = placement.yaw_deg * std::numbers::pi / 180;
  const double c = placement.scale * std::cos(yaw), s = placement.scale * std::sin(yaw);
  for (Vec3d& v : mesh.vertices) {
    v = Vec3d{c * v.x - s * v.y, s * v.x + c * v.y, placement.scale * v.z} + placement.position;
  }
  return mesh;
}

Obstacle LoadObstacle(const ObstacleSpec& spec) {
  if (spec.box) {
    return {BoxMesh(spec.box->low, spec.box->high), Block{spec.box->low, spec.box->high}};
  }
  if (!spec.mesh) {
    const Vec3d& centre = spec.placement.position;
    return {BallMesh(centre, spec.radius, kBallRounds), Ball{centre, spec.radius}};
  }
  TriangleMesh mesh = ReadMesh(*spec.mesh);
  if (const auto fault = SurfaceFault(mesh)) {
    throw InputError(spec.mesh->string(), 0, "this surface bounds no solid: " + *fault,
                     "close it and let its triangles run counter-clockwise seen from outside");
  }
  mesh = Placed(std::move(mesh), spec.placement);
  MeshDistance distance(mesh);
  return {std::move(mesh), std::move(distance)};
}

ShapeInTime LoadShape(const ShapeSpec& spec) {
  ShapeInTime shape{
      .name = spec.name, .times = {}, .meshes = {}, .period = spec.period, .path = spec.path};
  std::vector<std::filesystem::path> files;
  for (const ShapeSpec::KeyFrame& frame : spec.key_frames) {
    shape.times.push_back(frame.time);
    files.push_back(frame.mesh);
  }
  if (spec.period > 0 && files.size() > 1) {
    const AnimatedMesh animation = ReadKeyFrames(files);
    for (std::size_t k = 0; k < files.size(); ++k) shape.meshes.push_back(animation.Frame(k));
  } else if (spec.period > 0) {  // a file that holds the animation itself
    const AnimatedMesh animation = ReadAnimation(files[0], kPoses);
    for (int k = 0; k < kPoses; ++k) {
      shape.meshes.push_back(animation.Frame(static_cast<std::size_t>(k)));
      if (k > 0) shape.times.push_back(shape.times[0] + spec.period * k / kPoses);
    }
  } else {
    for (const std::filesystem::path& file : files) shape.meshes.push_back(ReadMesh(file));
  }
  for (TriangleMesh& mesh : shape.meshes) mesh = Placed(std::move(mesh), spec.placement);
  return shape;
}

}  // namespace

std::vector<Obstacle> LoadObstacles(const Scene& scene) {
  std::vector<Obstacle> obstacles;
  for (const ObstacleSpec& spec : scene.obstacles) obstacles.push_back(LoadObstacle(spec));
  return obstacles;
}

std::vector<ShapeInTime> LoadShapes(const Scene& scene) {
  std::vector<ShapeInTime> shapes;
  for (const ShapeSpec& spec : scene.shapes) shapes.push_back(LoadShape(spec));
  return shapes;
}

SurfaceDraw::SurfaceDraw(const TriangleMesh& mesh) : mesh_(mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3d& a = mesh.Corner(t, 0);
    sum += 0.5 * Norm(Cross(mesh.Corner(t, 1) - a, mesh.Corner(t, 2) - a));
    area_up_to_.push_back(sum);
  }
  Check(sum > 0, "a surface without area has no points to draw");
}

Vec3d SurfaceDraw::Draw(Rng* rng) const {
  const double at = rng->Uniform() * area_up_to_.back();
  const auto found = std::upper_bound(area_up_to_.begin(), area_up_to_.end() - 1, at);
  const auto t = static_cast<std::size_t>(found - area_up_to_.begin());
  const double u = std::sqrt(rng->Uniform()), w = rng->Uniform();  // uniform in the triangle
  return (1 - u) * mesh_.Corner(t, 0) + u * (1 - w) * mesh_.Corner(t, 1) +
         u * w * mesh_.Corner(t, 2);
}

}  // namespace flocklift
