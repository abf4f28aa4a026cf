// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/obstacle_field.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "simulate/forces/obstacle.h"

namespace flocklift {
namespace {

constexpr double kNodesPerRange = 4;
constexpr double kMostNodes = 4e6;  // of an obstacle's grid; beyond, it is made coarser

bool Inside(const Vec3d& p, const Vec3d& low, const Vec3d& high) {
  return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y &&
         p.z <= high.z;
}

}  // namespace

ObstacleField::ObstacleField(const std::vector<Obstacle>& obstacles, double range, int threads)
    : range_(range) {
  for (const Obstacle& obstacle : obstacles) {
    const Block box = Bounds(obstacle.solid);
    const Vec3d margin{1.5 * range, 1.5 * range, 1.5 * range};
    const Vec3d size = box.high - box.low + 2.0 * margin;
    const double finest = std::cbrt(size.x * size.y * size.z / kMostNodes);
    const Grid grid =
        GridOver(box.low - margin, box.high + margin, std::max(range / kNodesPerRange, finest));
    fields_.push_back(DistanceField(grid, std::span(&obstacle.solid, 1), threads));
  }
}

Vec3d ObstacleField::Turn(const Vec3d& position, Vec3d velocity) const {
  for (const ScalarField& field : fields_) {
    if (!Inside(position, field.grid.low, field.grid.High())) continue;
    const FieldSample sample = field.SampleLinear(position);
    velocity = ObstacleAvoidance::Turn(ObstacleAvoidance::Params<double>{range_}, sample.value,
                                       Normalized(sample.gradient), velocity);
  }
  return velocity;
}

}  // namespace flocklift
