// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// From sightings to the rows of a file: smooth, fill gaps, drop what is no animal.

#ifndef FLOCKLIFT_TRACK_FINISH_H_
#define FLOCKLIFT_TRACK_FINISH_H_

#include <vector>

#include "track/tracker.h"

namespace flocklift::internal {

// `frames_per_second` says how long "long" is. Counts rows in `report`.
Tracks FinishTracks(const TrackerOptions& options, const MotionNoise& noise,
                    std::optional<double> frames_per_second, double image_width,
                    double image_height, const std::vector<TrackRecord>& records,
                    TrackerReport* report);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_TRACK_FINISH_H_
