// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Depth of reconstructed points: camera-frame z.

#ifndef FLOCKLIFT_TOOLS_REPORT_CAMERA_DEPTH_H_
#define FLOCKLIFT_TOOLS_REPORT_CAMERA_DEPTH_H_

#include "simulate/camera/camera.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

inline double DepthOf(const Camera& camera, const TrajectoryPoint& point) {
  return (camera.CamFromWorld(point.frame) * point.position).z;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_REPORT_CAMERA_DEPTH_H_
