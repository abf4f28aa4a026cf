// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where a flight of a crowd (simulate/flock/crowd_model.h) can begin in the middle of its walk. A
// crowd knows no noise, and where many meet small differences grow, so that a flight is as good as
// its start. Two things of the start are felt for long. A crowd is looked at every so many steps: a
// flight begins when it is. Who is looked at counts with the velocity of the step that led to where
// he is: between the differences of his places on either side of it, and where these differ it is
// not known better than that. How anybody came to the first frame is not seen.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_CROWD_START_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_CROWD_START_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "reconstruct/fit/motion_statistics.h"
#include "simulate/core/trajectory.h"
#include "simulate/flock/model.h"

namespace flocklift {

// mean + doubt N(0, 1) [m/s].
struct ArrivalVelocity {
  Vec3d mean, doubt;
};
// Of the last of `substeps` steps that led to point k of a path.
ArrivalVelocity VelocityOfArrival(const std::vector<TrajectoryPoint>& path, std::size_t k,
                                  double fps, int substeps);

// The first of the fullest frames that have one before and in which the crowd is looked at, or, of
// too few frames for that, of all; `first_step`: steps of `dt` [s] from the scene's start to
// frames[0].
std::size_t CrowdStartFrame(const std::vector<FramePositions>& frames, const ModelSpec& crowd,
                            std::int64_t first_step, int substeps, double dt);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_CROWD_START_H_
