// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Some frames of tracks and trajectories that are in memory: by halving, not by looking at all.

#ifndef FLOCKLIFT_TOOLS_VIEW_CUT_H_
#define FLOCKLIFT_TOOLS_VIEW_CUT_H_

#include <memory>
#include <vector>

#include "simulate/core/observations.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

// Tracks by increasing id, shared by whoever looks at them: none changes any more.
using TrackList = std::vector<std::shared_ptr<const Tracklet>>;

TrackList Shared(Tracks tracks);
Tracks AsTracks(const TrackList& list);

// The rows of frames `first` to `last`, and the animals that have any.
Tracks Cut(const TrackList& tracks, int first, int last);
Trajectories Cut(const Trajectories& trajectories, int first, int last);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_CUT_H_
