// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Projection and rays of OpenCV's pinhole model. With x' = x/z, y' = y/z, r2 = x'^2 + y'^2:
//   radial = (1 + k1 r2 + k2 r2^2 + k3 r2^3) / (1 + k4 r2 + k5 r2^2 + k6 r2^3)
//   x'' = x' radial + 2 p1 x'y' + p2 (r2 + 2 x'^2) + s1 r2 + s2 r2^2
//   y'' = y' radial + p1 (r2 + 2 y'^2) + 2 p2 x'y' + s3 r2 + s4 r2^2
//   u = fx x'' + cx,  v = fy y'' + cy
// (OpenCV documentation, calib3d). Templated on the scalar: double and ceres::Jet.

#ifndef FLOCKLIFT_SIMULATE_CAMERA_PROJECTION_H_
#define FLOCKLIFT_SIMULATE_CAMERA_PROJECTION_H_

#include <optional>

#include "simulate/camera/camera.h"
#include "simulate/core/vec3.h"

namespace flocklift {

// Image point [px] of normalised coordinates (x/z, y/z).
template <typename T>
Vec2<T> ProjectNormalized(const Intrinsics& k, const Vec2<T>& n) {
  const auto& d = k.distortion;
  const T r2 = n.x * n.x + n.y * n.y;
  const T radial =
      (1.0 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]))) / (1.0 + r2 * (d[5] + r2 * (d[6] + r2 * d[7])));
  const T xy2 = 2.0 * n.x * n.y;
  const T x = n.x * radial + d[2] * xy2 + d[3] * (r2 + 2.0 * n.x * n.x) + r2 * (d[8] + r2 * d[9]);
  const T y = n.y * radial + d[2] * (r2 + 2.0 * n.y * n.y) + d[3] * xy2 + r2 * (d[10] + r2 * d[11]);
  return {k.fx * x + k.cx, k.fy * y + k.cy};
}

// Image point [px] of a point in the camera frame; its depth must be positive (cheirality).
template <typename T>
Vec2<T> Project(const Intrinsics& k, const Vec3<T>& point_in_cam) {
  return ProjectNormalized(
      k, Vec2<T>{point_in_cam.x / point_in_cam.z, point_in_cam.y / point_in_cam.z});
}

// Normalised coordinates (x/z, y/z) of the ray through an image point: the inverse of
// ProjectNormalized, by Newton's method to the precision of a double. Strong distortion folds the
// plane, and several rays may then meet one pixel: returned is the one that connects to the optical
// axis without crossing a fold, and nothing where there is none.
std::optional<Vec2d> RayThroughPixel(const Intrinsics& k, const Vec2d& pixel);

// Image point [px] of a point in the camera frame, if the camera sees it: in front, on the sensor,
// and not brought there by a fold of the distortion (which Project does not notice).
std::optional<Vec2d> ProjectVisible(const Camera& camera, const Vec3d& point_in_cam);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CAMERA_PROJECTION_H_
