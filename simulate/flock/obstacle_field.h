// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Obstacles as motions avoid them (simulate/forces/obstacle.h): the distance to the nearest one and
// the way out, from a grid around each.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_OBSTACLE_FIELD_H_
#define FLOCKLIFT_SIMULATE_FLOCK_OBSTACLE_FIELD_H_

#include <vector>

#include "simulate/fields/distance_field.h"
#include "simulate/flock/world.h"

namespace flocklift {

class ObstacleField {
 public:
  // Reaches `range` beyond each obstacle [m].
  ObstacleField(const std::vector<Obstacle>& obstacles, double range, int threads);

  bool empty() const { return fields_.empty(); }
  // Takes from `velocity` at `position` what flies into obstacles nearer than the range.
  Vec3d Turn(const Vec3d& position, Vec3d velocity) const;

 private:
  double range_;
  std::vector<ScalarField> fields_;  // signed distance, one for each obstacle
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_OBSTACLE_FIELD_H_
