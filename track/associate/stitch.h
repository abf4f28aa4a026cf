// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Joins tracks across gaps: one that ends and one that begins soon after where the first would be,
// moving as it moved. All joins are chosen together, at the least total cost: that of each join
// (join_cost.h) against that of an end and an unrelated beginning, -ln(density of beginnings per
// px^2, frame and (px/frame)^2). Each track follows at most one and is followed by at most one, so
// this is min-cost flow with unit capacities, solved as an assignment of ends to beginnings; what
// may follow what comes from successors.h.

#ifndef FLOCKLIFT_TRACK_ASSOCIATE_STITCH_H_
#define FLOCKLIFT_TRACK_ASSOCIATE_STITCH_H_

#include <vector>

#include "simulate/core/options.h"
#include "track/associate/flock_tracker.h"
#include "track/predict/motion_noise.h"

namespace flocklift {

struct StitchOptions {
  int max_gap = 45;                  // 0: no stitching [frames]
  double gate_probability = 0.9999;  // chi-square mass inside the gate
};

template <typename Visitor>
void Describe(Visitor& visit, StitchOptions& o) {
  visit("max-gap", o.max_gap, {.low = 0, .high = 10000}, "frames",
        "longest gap over which two tracks are joined");
  visit("stitch-gate-probability", o.gate_probability, {.low = 0.5, .high = 0.999999}, "",
        "share of true joins inside the gate");
}

// `tracks` by first frame, and so are the results. `joins` counts what was joined.
std::vector<TrackRecord> Stitch(const StitchOptions& options, const MotionNoise& noise,
                                double image_width, double image_height,
                                std::vector<TrackRecord> tracks, int* joins);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_ASSOCIATE_STITCH_H_
