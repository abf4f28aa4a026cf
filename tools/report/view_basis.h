// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The directions of the top and the side view: seen from the camera, what is to the right, ahead
// and up, in metres. Where gravity is known, up is the world's z and height counts from z = 0;
// else up is the image's and height counts from the optical axis.

#ifndef FLOCKLIFT_TOOLS_REPORT_VIEW_BASIS_H_
#define FLOCKLIFT_TOOLS_REPORT_VIEW_BASIS_H_

#include "simulate/camera/camera.h"
#include "simulate/core/vec3.h"

namespace flocklift {

class ViewBasis {
 public:
  // Of the camera's pose in `frame`.
  ViewBasis(const Camera& camera, int frame);

  // (right of the camera, ahead of it, height) of a point in the world frame.
  Vec3d FromWorld(const Vec3d& point_in_world) const;
  // The same of a direction: height does not count from the ground.
  Vec3d Turned(const Vec3d& direction_in_world) const;

  Vec3d camera() const { return FromWorld(camera_in_world_); }
  bool knows_gravity() const { return knows_gravity_; }

 private:
  Vec3d right_, ahead_, up_;  // unit vectors in the world frame
  Vec3d camera_in_world_;
  bool knows_gravity_ = false;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_REPORT_VIEW_BASIS_H_
