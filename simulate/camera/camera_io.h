// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Camera files: OpenCV FileStorage YAML as OpenCV's calibration sample writes it, with optional
// `fps`, `cam_from_world` (3x4) and `cam_from_world_per_frame` (F x 12).

#ifndef FLOCKLIFT_SIMULATE_CAMERA_CAMERA_IO_H_
#define FLOCKLIFT_SIMULATE_CAMERA_CAMERA_IO_H_

#include <filesystem>
#include <string>

#include "simulate/camera/camera.h"

namespace flocklift {

// Throws InputError: a missing key, a singular matrix, a rotation that is none, a NaN.
Camera ReadCamera(const std::filesystem::path& path);
Camera ParseCamera(const std::string& text, const std::string& name);
void WriteCamera(const std::filesystem::path& path, const Camera& camera);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CAMERA_CAMERA_IO_H_
