// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a depth solver hands back for one segment.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_SOLVED_PATH_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_SOLVED_PATH_H_

#include <vector>

#include "simulate/core/vec3.h"

namespace flocklift {

// At one sighting, in the axes of the reference camera.
struct SolvedPoint {
  Vec3d position_in_cam;      // [m]
  Vec3d velocity_in_cam;      // [m/s]
  Vec3d acceleration_in_cam;  // [m/s^2]
  double sd_log_depth = 0;    // 1 sigma of log z, common scale included; 0: not known
};

// One point per sighting of the segment.
using SolvedPath = std::vector<SolvedPoint>;

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_SOLVED_PATH_H_
