// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A camera that moves from key position to key position. Position and point of view go along cubic
// Hermite splines in time; with d_k the slope of the straight line from key k to k + 1 and h_k its
// duration, the velocity at an inner key is that of the parabola through it and its neighbours,
//   m_k = (h_k d_{k-1} + h_{k-1} d_k) / (h_{k-1} + h_k),
// and 0 at the first and last keys: the camera rests before and after, and its motion is C1
// throughout. Image up stays world up.

#ifndef FLOCKLIFT_SIMULATE_CAMERA_CAMERA_PATH_H_
#define FLOCKLIFT_SIMULATE_CAMERA_CAMERA_PATH_H_

#include <span>
#include <vector>

#include "simulate/core/rigid3.h"
#include "simulate/core/scene.h"

namespace flocklift {

using CameraKey = CameraSpec::Pose;

// Where the camera is at `time`; the first or last key outside their times. There must be a key,
// and times must increase.
CameraKey CameraKeyAt(std::span<const CameraKey> keys, double time);

// cam_from_world of frames 1 to `frames`, for a camera file. Throws std::invalid_argument when on
// its way the camera comes upon the point that it looks at.
std::vector<Rigid3d> FollowKeys(std::span<const CameraKey> keys, double fps, int frames);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CAMERA_CAMERA_PATH_H_
