// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/target_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "reconstruct/fit/goal_groups.h"
#include "simulate/fields/mesh_distance.h"
#include "simulate/flock/shape_targets.h"

namespace flocklift::internal {
namespace {

constexpr std::size_t kFrames = 12;  // at most, that are looked at

std::size_t Stride(const FlightStart& start) {
  return std::max<std::size_t>(1, (start.frames + kFrames - 1) / kFrames);
}

double TimeOf(const FlightStart& start, std::size_t frame) {
  const double steps = static_cast<double>(start.steps_before) +
                       static_cast<double>(frame) * static_cast<double>(start.substeps);
  return start.world.time + steps * start.world.dt;
}

const ShapeInTime* FindShape(const FlightStart& start) {
  for (const ShapeInTime& shape : start.world.shapes) {
    if (shape.name == start.swarm.shape) return &shape;
  }
  return nullptr;
}

const PathSpec* FindPath(const FlightStart& start, const ShapeInTime& shape) {
  const std::string& name = start.swarm.path.empty() ? shape.path : start.swarm.path;
  for (const PathSpec& path : start.world.paths) {
    if (path.name == name) return &path;
  }
  return nullptr;
}

using Surfaces = std::vector<std::shared_ptr<const MeshDistance>>;

// By frame that is looked at.
Surfaces SurfacesOf(const FlightStart& start, const ShapeInTime& shape) {
  Surfaces surfaces;
  const bool morphs = start.swarm.spec.name == "morph";  // a path is the way there
  const PathSpec* const path = morphs ? nullptr : FindPath(start, shape);
  if (morphs || (path == nullptr && shape.meshes.size() == 1)) {
    surfaces.assign(kFrames, std::make_shared<const MeshDistance>(shape.meshes.front()));
    return surfaces;
  }
  const ShapeTargets targets(shape, path, start.world.duration, {Vec3d{}}, start.world.time, 1, 1);
  for (std::size_t frame = 0; frame < start.frames; frame += Stride(start)) {
    surfaces.push_back(std::make_shared<const MeshDistance>(targets.MeshAt(TimeOf(start, frame))));
  }
  return surfaces;
}

TargetDistances ToSurface(const FlightStart& start, const ShapeInTime& shape) {
  return [surfaces = SurfacesOf(start, shape), stride = Stride(start)](
             std::size_t frame, const std::vector<Vec3d>& places) {
    std::vector<double> distances;
    if (frame % stride != 0) return distances;
    std::uint32_t hint = 0;
    for (const Vec3d& place : places) {
      const SurfacePoint nearest = surfaces[frame / stride]->Closest(place, hint);
      hint = nearest.triangle;
      distances.push_back(std::abs(nearest.distance));
    }
    return distances;
  };
}

TargetDistances ToGoal(const FlightStart& start) {
  std::vector<std::vector<Vec3d>> goals;
  for (std::size_t frame = 0; frame < start.frames; frame += Stride(start)) {
    goals.push_back(GoalsAt(start.world, start.swarm.species, TimeOf(start, frame)));
  }
  return [goals, stride = Stride(start)](std::size_t frame, const std::vector<Vec3d>& places) {
    std::vector<double> distances;
    if (frame % stride != 0) return distances;
    for (const Vec3d& place : places) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vec3d& goal : goals[frame / stride]) {
        nearest = std::min(nearest, Norm(place - goal));
      }
      distances.push_back(nearest);
    }
    return distances;
  };
}

}  // namespace

TargetDistances MakeTargetDistances(const FlightStart& start) {
  if (const ShapeInTime* const shape = FindShape(start)) return ToSurface(start, *shape);
  if (GoalsAt(start.world, start.swarm.species, start.world.time).empty()) return {};
  return ToGoal(start);
}

}  // namespace flocklift::internal
