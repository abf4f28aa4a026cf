// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Curves over time under the pictures: of the flock as a whole, and of one animal. Depth is along
// the optical axis, or the height where there is no camera [m].

#ifndef FLOCKLIFT_TOOLS_VIEW_FLOCK_SERIES_H_
#define FLOCKLIFT_TOOLS_VIEW_FLOCK_SERIES_H_

#include <nlohmann/json.hpp>
#include <optional>

#include "simulate/camera/camera.h"
#include "simulate/core/trajectory.h"
#include "tools/view/frame_table.h"

namespace flocklift {

// {"frames": [..], "depth": [..], "speed": [..], "neighbour": [..], "polarisation": [..]}: medians
// over the animals of each frame that has rows, null where there is none.
nlohmann::ordered_json FlockSeries(const TrajectoryTable& table,
                                   const std::optional<Camera>& camera);

// The same of one animal, with "sd_depth", over the frames in which it is there.
nlohmann::ordered_json AnimalSeries(const TrajectoryTable& table,
                                    const std::optional<Camera>& camera, std::uint32_t animal);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_FLOCK_SERIES_H_
