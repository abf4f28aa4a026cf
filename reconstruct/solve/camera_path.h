// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How a moving camera goes, as the animals' paths are held (cost_functions/path.h): a cubic
// B-spline on the knots of the sequence, least squares through its places in the frames. What the
// animals' velocities and accelerations get from the camera then fits what their rays lose to it.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_CAMERA_PATH_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_CAMERA_PATH_H_

#include <vector>

#include "reconstruct/cost_functions/path.h"
#include "simulate/core/vec3.h"

namespace flocklift::internal {

class CameraPath {
 public:
  CameraPath() = default;  // stands still
  // places[k]: at time k / fps, reference axes [m]; empty for a camera that stands still.
  CameraPath(const std::vector<Vec3d>& places, double fps, double knot_interval);

  bool moves() const { return !controls_.empty(); }
  CameraMotion At(double time) const;

 private:
  double interval_ = 1;
  std::vector<Vec3d> controls_;  // control k - 1 .. k + 2 about the interval after knot k
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_CAMERA_PATH_H_
