// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/wall_field.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulate/core/check.h"
#include "simulate/fields/distance_field.h"

namespace flocklift {
namespace {

// To the nearest face of a box, positive inside.
double DistanceWithin(const Region& box, bool upright, const Vec3d& p) {
  const double sides =
      std::min({p.x - box.low.x, box.high.x - p.x, p.y - box.low.y, box.high.y - p.y});
  return upright ? std::min({sides, p.z - box.low.z, box.high.z - p.z}) : sides;
}

}  // namespace

ScalarField WallField(const World& world, double spacing, int threads,
                      std::optional<double> ground) {
  const Region& box = world.box;
  Check(std::isfinite(Norm(box.high - box.low)), "a swarm with goals or obstacles needs a box");
  const Vec3d rim{spacing, spacing, spacing};
  Vec3d low = box.low - rim, high = box.high + rim;
  if (ground) low.z = high.z = *ground;
  std::vector<Solid> solids;
  for (const Obstacle& obstacle : world.obstacles) solids.push_back(obstacle.solid);
  ScalarField field = DistanceField(GridOver(low, high, spacing), solids, threads);
  for (std::size_t node = 0; node < field.grid.size(); ++node) {
    field.values[node] =
        std::min(field.values[node],
                 static_cast<float>(DistanceWithin(box, !ground, field.grid.Node(node))));
  }
  return field;
}

}  // namespace flocklift
