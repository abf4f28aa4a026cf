// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// From sightings to the rows of a file: smooth, fill gaps, drop what is no animal.

#ifndef FLOCKLIFT_TRACK_FINISH_H_
#define FLOCKLIFT_TRACK_FINISH_H_

#include <vector>

#include "track/camera_path.h"
#include "track/tracker.h"

namespace flocklift::internal {

// `records` are in the world of `camera`, the rows in their frames' pictures. Gives each track to
// `take` as soon as it is finished, holding no other's rows. `report`, which has the fps that say
// how long "long" is, gets counts of rows and, ranked, what is to be doubted. Confidence: 1 where
// the animal had a blob of its own; from 0.9 down to 0.5 where it shared one, the less it could be
// told from the others; below 0.5, and the lower the less is known of the place, where it was not
// seen.
void FinishTracks(const TrackerOptions& options, const MotionNoise& noise, double image_width,
                  double image_height, const CameraPath& camera, std::vector<TrackRecord> records,
                  const TakeTracklet& take, TrackerReport* report);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_TRACK_FINISH_H_
