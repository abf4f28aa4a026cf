// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// OpenCV's pinhole camera with distortion. Camera frame: x right, y down, z forward; depth is z.
// Pixels: u right, v down, the centre of the top-left pixel at (0, 0).

#ifndef FLOCKLIFT_SIMULATE_CAMERA_CAMERA_H_
#define FLOCKLIFT_SIMULATE_CAMERA_CAMERA_H_

#include <array>
#include <optional>
#include <vector>

#include "simulate/core/rigid3.h"
#include "simulate/core/vec3.h"

namespace flocklift {

// Focal lengths and principal point [px], and OpenCV's coefficients in its order:
// k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 (those a file does not give are 0).
struct Intrinsics {
  double fx = 1, fy = 1, cx = 0, cy = 0;
  std::array<double, 12> distortion{};

  friend bool operator==(const Intrinsics&, const Intrinsics&) = default;
};

struct Camera {
  int width = 0, height = 0;  // [px]
  Intrinsics intrinsics;
  std::optional<double> fps;                      // [1/s]
  std::optional<Rigid3d> cam_from_world;          // absent: the world is the camera's own axes, and
                                                  // gravity is unknown
  std::vector<Rigid3d> cam_from_world_per_frame;  // a moving camera: entry k is frame k + 1

  // Extrinsics in `frame` (from 1): per frame where given, else the fixed ones, else the identity.
  // A moving camera without a fixed pose must know the frame.
  Rigid3d CamFromWorld(int frame) const;
  bool KnowsGravity() const { return cam_from_world || !cam_from_world_per_frame.empty(); }
  // Is the point on the sensor, edges of the outermost pixels included?
  bool Sees(const Vec2d& pixel) const;

  friend bool operator==(const Camera&, const Camera&) = default;
};

// A camera without distortion and pose: square pixels, principal point in the middle, horizontal
// field of view over the full width, fx = (width / 2) / tan(fov / 2). fov in (0, 180) degrees.
Camera PinholeCamera(double horizontal_fov_deg, int width, int height);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CAMERA_CAMERA_H_
