// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Camera files: OpenCV FileStorage YAML as OpenCV's calibration sample writes it. Keys:
//   image_width, image_height    [px]
//   camera_matrix                3 x 3, [fx 0 cx; 0 fy cy; 0 0 1]
//   distortion_coefficients      4, 5, 8 or 12 in OpenCV's order (14 if the last two are 0)
//   fps                          optional: a number, or a ratio such as "30000/1001"
//   cam_from_world               optional, 3 x 4; in its place R (3 x 3) and t (3) are read, too
//   cam_from_world_per_frame     optional, F x 12, each row a 3 x 4 by rows; row 1 is frame 1
// Other keys are ignored, except those that name another camera model.

#ifndef FLOCKLIFT_SIMULATE_CAMERA_CAMERA_IO_H_
#define FLOCKLIFT_SIMULATE_CAMERA_CAMERA_IO_H_

#include <filesystem>
#include <string>

#include "simulate/camera/camera.h"

namespace flocklift {

// Throw InputError: a missing key, a singular matrix, a rotation that is none, a NaN, a lens that
// is not of this model. Rotations off by the rounding of a few printed digits (1e-4) are mended.
Camera ReadCamera(const std::filesystem::path& path);
Camera ParseCamera(const std::string& text, const std::string& name);

// What is written reads back bit by bit, here and in OpenCV. Throws std::runtime_error when the
// file cannot be written, and then leaves none.
void WriteCamera(const std::filesystem::path& path, const Camera& camera);
std::string FormatCamera(const Camera& camera);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CAMERA_CAMERA_IO_H_
