// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How well one stretch of a track goes on in another: the negative log likelihood of the second's
// state at its first sighting, given the first's at its last, t frames before. Per axis
//   e = (x_b, v_b) - F (x_a, v_a),   C = F P_a F' + Q + P_b,
//   cost = 1/2 sum over axes of e' C^-1 e + ln((2 pi)^2 |C|).

#ifndef FLOCKLIFT_TRACK_ASSOCIATE_JOIN_COST_H_
#define FLOCKLIFT_TRACK_ASSOCIATE_JOIN_COST_H_

#include <span>

#include "track/associate/flock_tracker.h"
#include "track/predict/kalman.h"
#include "track/predict/motion_noise.h"

namespace flocklift {

struct JoinCost {
  double squared_distance = 0;  // e' C^-1 e, 4 degrees of freedom
  double cost = 0;              // [-ln of 1/(px^2 (px/frame)^2)]
};

// `q` is the process noise over the gap of `frames`.
JoinCost CostOfJoin(const MotionState& end, const MotionState& begin, double q, int frames);

// The motion at the last (or first) of some sightings, from them alone.
MotionState StateAtLast(std::span<const TrackPoint> sightings, double size,
                        const MotionNoise& noise);
MotionState StateAtFirst(std::span<const TrackPoint> sightings, double size,
                         const MotionNoise& noise);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_ASSOCIATE_JOIN_COST_H_
