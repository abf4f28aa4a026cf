// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tracks drawn over the footage: boxes, trails and ids in the colour of each id.

#ifndef FLOCKLIFT_TOOLS_TRACK_OVERLAY_H_
#define FLOCKLIFT_TOOLS_TRACK_OVERLAY_H_

#include <filesystem>
#include <functional>
#include <optional>

#include "simulate/core/image.h"
#include "simulate/core/observations.h"
#include "simulate/core/progress.h"

namespace flocklift {

// Draws the tracks of one frame, thin where they are interpolated, with `trail` frames of their
// past.
void DrawTracks(const Tracks& tracks, int frame, int trail, Image* image);

// The rows of some frames, of tracks that memory need not hold.
using TracksBetween = std::function<Tracks(int first_frame, int last_frame)>;

// The whole video at `fps`, or its own rate (30/s when it has none).
void WriteTrackOverlay(const std::filesystem::path& footage, const TracksBetween& tracks,
                       std::optional<double> fps, const std::filesystem::path& video,
                       const Progress& progress);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_TRACK_OVERLAY_H_
