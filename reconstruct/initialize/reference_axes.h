// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The axes in which a flock is reconstructed: those of a camera that stands still; of a camera that
// turns, axes at rest that look the way it looks on average. Positions count from the place where
// the camera is in the same frame.

#ifndef FLOCKLIFT_RECONSTRUCT_INITIALIZE_REFERENCE_AXES_H_
#define FLOCKLIFT_RECONSTRUCT_INITIALIZE_REFERENCE_AXES_H_

#include <optional>

#include "simulate/camera/camera.h"
#include "simulate/core/rigid3.h"
#include "simulate/core/vec3.h"

namespace flocklift {

class ReferenceAxes {
 public:
  // `camera` stays the caller's; frames first .. last. Throws std::invalid_argument when the camera
  // looks all around, or its pose in one of the frames is not known.
  ReferenceAxes(const Camera& camera, int first_frame, int last_frame);

  bool moves() const { return moves_; }  // does the camera's place change?
  bool turns() const { return turns_; }
  const Rotation3d& ref_from_world() const { return ref_from_world_; }

  Rigid3d RefFromWorld(int frame) const;
  Rigid3d WorldFromRef(int frame) const;
  // The same between frames, on the straight line from place to place; past the ends as there.
  Rigid3d WorldFromRef(double frame) const;
  // The camera's place from that in the first frame, reference axes [m].
  Vec3d CameraPlace(int frame) const;

  // Depth (z of the camera's own axes) of a position that counts from the camera.
  double DepthInCam(int frame, const Vec3d& position_in_ref) const;

  // A ray (x/z, y/z) of the camera in the reference axes, and how much larger small angles look
  // there. Absent where it points more than 75 degrees away from the reference axis.
  struct Turned {
    Vec2d ray;
    double magnification = 1;
  };
  std::optional<Turned> Turn(int frame, const Vec2d& ray_in_cam) const;

 private:
  const Camera& camera_;
  int first_frame_, last_frame_;
  bool moves_ = false, turns_ = false;
  Rotation3d ref_from_world_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_INITIALIZE_REFERENCE_AXES_H_
