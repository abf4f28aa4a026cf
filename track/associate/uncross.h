// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Second thoughts about who left a shared blob as whom. While two animals could not be told apart,
// their tracks may have changed places; afterwards, what each did before and after says which way
// round is likelier: motion (join_cost.h) and size,
//   cost(a -> a') + cost(b -> b')  against  cost(a -> b') + cost(b -> a').

#ifndef FLOCKLIFT_TRACK_ASSOCIATE_UNCROSS_H_
#define FLOCKLIFT_TRACK_ASSOCIATE_UNCROSS_H_

#include <vector>

#include "track/associate/flock_tracker.h"
#include "track/predict/motion_noise.h"

namespace flocklift {

// Exchanges the rest of two tracks after a shared blob where that is clearly likelier. Returns how
// many times it did.
int Uncross(const MotionNoise& noise, std::vector<TrackRecord>* tracks);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_ASSOCIATE_UNCROSS_H_
