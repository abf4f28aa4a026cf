// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// `flocklift track --from`: goes on from what another program found.

#ifndef FLOCKLIFT_TOOLS_TRACK_FROM_H_
#define FLOCKLIFT_TOOLS_TRACK_FROM_H_

#include "tools/stage.h"
#include "tools/track_command.h"

namespace flocklift {

// Reads command.from and links or joins it. Warns where the file has no sizes.
TrackerResult TrackFrom(const TrackCommand& command, const CommonOptions& common, Stage* stage);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_TRACK_FROM_H_
