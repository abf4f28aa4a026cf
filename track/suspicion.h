// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The frames of a run that a person should look at, the likeliest mistake first. A close decision
// between two ways c0 and c1 (negative log likelihoods) was wrong with the chance
// 1 / (1 + exp(c1 - c0)), where c0 is the way that was taken.

#ifndef FLOCKLIFT_TRACK_SUSPICION_H_
#define FLOCKLIFT_TRACK_SUSPICION_H_

#include <span>
#include <vector>

#include "simulate/core/observations.h"
#include "track/associate/doubt.h"
#include "track/associate/flock_tracker.h"
#include "track/camera_path.h"
#include "track/predict/motion_noise.h"

namespace flocklift {

struct Suspicion {
  Doubt doubt;
  std::vector<Id> ids;  // of the finished tracks, one or two
};

// "swap", "merge", ..
const char* NameOf(DoubtKind kind);

// The picture, and the frames that were looked at.
struct Footage {
  double width = 0, height = 0;  // [px]
  int first_frame = 1, last_frame = 1;
};

// What a track makes doubt by itself: jumps, long stays behind others, and beginnings and ends
// inside the picture. Its sightings, not none, are in the world of `camera`; `size` is its own.
std::vector<Doubt> DoubtsOf(const MotionNoise& noise, const Footage& footage,
                            const internal::CameraPath& camera, double size,
                            std::span<const TrackPoint> sightings);

// Doubts of finished tracks; `ids` has one for each record (kNoId: the track was dropped). Those
// of two tracks about the same encounter become one.
std::vector<Suspicion> RankSuspicions(std::span<const TrackRecord> records,
                                      std::span<const Id> ids);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_SUSPICION_H_
