// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A camera as the page takes it.

#ifndef FLOCKLIFT_TOOLS_VIEW_CAMERA_JSON_H_
#define FLOCKLIFT_TOOLS_VIEW_CAMERA_JSON_H_

#include <nlohmann/json.hpp>

#include "simulate/camera/camera.h"

namespace flocklift {

// {"width", "height", "fx", "fy", "cx", "cy", "gravity", "pose": 12 numbers or null, "poses": 12 a
// frame}; a pose is cam_from_world as the rows [r r r t].
nlohmann::ordered_json CameraAsJson(const Camera& camera);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_CAMERA_JSON_H_
